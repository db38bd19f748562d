# The report page: app/report/page/ and Debian's three.js and Chart.js inlined into the executable,
# so that report.html opens anywhere, offline. Included by the project it declares the build step;
# run as a script (cmake -P) it is the build step.

function(photonav_embed_report target)
    find_file(THREE_JS three.min.js PATHS /usr/share/javascript/three NO_DEFAULT_PATH REQUIRED)
    find_file(ORBIT_CONTROLS_JS OrbitControls.js
        PATHS /usr/share/javascript/three/examples/js/controls NO_DEFAULT_PATH REQUIRED)
    find_file(CHART_JS chart.min.js PATHS /usr/share/javascript/chart.js NO_DEFAULT_PATH REQUIRED)
    mark_as_advanced(THREE_JS ORBIT_CONTROLS_JS CHART_JS)

    set(page ${PROJECT_SOURCE_DIR}/app/report/page)
    set(parts ${THREE_JS} ${ORBIT_CONTROLS_JS} ${CHART_JS} ${page}/page.css ${page}/data.js
        ${page}/head.js ${page}/shapes3d.js ${page}/map3d.js ${page}/view3d.js ${page}/charts.js ${page}/sweep.js
        ${page}/flight.js ${page}/flight3d.js ${page}/flightpanel.js
        ${page}/frames.js ${page}/cost.js ${page}/words.js ${page}/numbers.js ${page}/page.js)
    set(script ${PROJECT_SOURCE_DIR}/cmake/embed_report.cmake)
    set(generated ${PROJECT_BINARY_DIR}/generated/report_page.cpp)
    add_custom_command(OUTPUT ${generated}
        COMMAND ${CMAKE_COMMAND} -DOUTPUT=${generated} -DPAGE=${page}/page.html "-DPARTS=${parts}"
            -P ${script}
        DEPENDS ${script} ${page}/page.html ${parts}
        COMMENT "Inlining the report page" VERBATIM)
    target_sources(${target} PRIVATE ${generated})
    set_source_files_properties(${generated} PROPERTIES
        SKIP_PRECOMPILE_HEADERS ON SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

if(NOT CMAKE_SCRIPT_MODE_FILE)
    return()
endif()

# Every part goes where the page says @name@.
file(READ ${PAGE} html)
foreach(part IN LISTS PARTS)
    get_filename_component(name ${part} NAME)
    file(READ ${part} content)
    if(name MATCHES "[.]js$")
        # Inside <script> only these two can confuse a browser; the first is written otherwise in
        # any string or regular expression, the second occurs in no sane script.
        string(REPLACE "</script" "<\\/script" content "${content}")
        string(FIND "${content}" "<!--" comment)
        if(comment GREATER -1)
            message(FATAL_ERROR "${part} contains <!--, which cannot be inlined")
        endif()
    endif()
    string(REPLACE "@${name}@" "${content}" html "${html}")
endforeach()
file(WRITE ${OUTPUT} "#include <string_view>
namespace photonav {
extern const std::string_view kReportPage;
const std::string_view kReportPage = R\"photonav_page(${html})photonav_page\";
}  // namespace photonav
")
