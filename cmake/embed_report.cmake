# The report page: app/report_page/ and Debian's three.js and Chart.js inlined into the executable,
# so that report.html opens anywhere, offline.
function(photonav_embed_report target)
    find_file(THREE_JS three.min.js PATHS /usr/share/javascript/three NO_DEFAULT_PATH REQUIRED)
    find_file(ORBIT_CONTROLS_JS OrbitControls.js
        PATHS /usr/share/javascript/three/examples/js/controls NO_DEFAULT_PATH REQUIRED)
    find_file(CHART_JS chart.min.js PATHS /usr/share/javascript/chart.js NO_DEFAULT_PATH REQUIRED)
endfunction()
