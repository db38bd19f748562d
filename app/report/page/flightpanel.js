// A flight beside the 3-D view: time, images, grids, counters, and the charts over time.
'use strict';

// Colours of viridis, dark to bright.
const kViridis = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141],
                  [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];
function viridis(share) {
  const at = Math.max(0, Math.min(1, share)) * (kViridis.length - 1), i = Math.min(kViridis.length - 2, Math.floor(at));
  return kViridis[i].map((from, c) => Math.round(from + (at - i) * (kViridis[i + 1][c] - from)));
}

const kObstacleColors = {0: [122, 130, 140], 85: [24, 28, 33], 170: [198, 170, 150], 255: [247, 247, 244]};
// As kFullDifference and kUnknownColor of the executable.
const kFullDifference = 0.25, kUnknownColor = [24, 44, 92];
const kNotPredicted = 2;  // largest grey level of a pixel without a surface, after compression
const kNoInformation = 255, kLevelsPerDecade = 20;

/// @param flight3d null without WebGL
function createFlightPanel(flight3d) {
  let time = 0, shown = -1, playing = 0, following = flight.live;
  const grids = {};  // decoded: {width, height, levels} by PNG

  // Grids ------------------------------------------------------------------------------------------
  function decode(png, then) {
    if (!png || grids[png]) return then(grids[png]);
    const image = new Image();
    image.onload = () => {
      const sheet = document.createElement('canvas');
      [sheet.width, sheet.height] = [image.width, image.height];
      const pen = sheet.getContext('2d');
      pen.drawImage(image, 0, 0);
      const pixels = pen.getImageData(0, 0, image.width, image.height).data;
      grids[png] = {width: image.width, height: image.height, levels: pixels.filter((_, i) => i % 4 === 0)};
      then(grids[png]);
    };
    image.src = `data:image/png;base64,${png}`;
  }

  /// Draws a grid with the way and the plan over it.
  function drawGrid(id, grid, colorOf) {
    const canvas = element(id), {header} = flight;
    const [least, largest] = header.area, aspect = (largest[1] - least[1]) / (largest[0] - least[0]);
    canvas.width = 640;
    canvas.height = Math.max(1, Math.round(canvas.width * aspect));
    const pen = canvas.getContext('2d');
    if (grid) {
      const sheet = document.createElement('canvas');
      [sheet.width, sheet.height] = [grid.width, grid.height];
      const pixels = new ImageData(grid.width, grid.height);
      grid.levels.forEach((level, i) => pixels.data.set([...colorOf(level), 255], 4 * i));
      sheet.getContext('2d').putImageData(pixels, 0, 0);
      pen.imageSmoothingEnabled = false;
      pen.drawImage(sheet, 0, 0, canvas.width, canvas.height);
    }
    const at = ([x, y]) => [(x - least[0]) / (largest[0] - least[0]) * canvas.width,
                            (largest[1] - y) / (largest[1] - least[1]) * canvas.height];
    const line = (places, color, width) => {
      if (places.length < 2) return;
      for (const [style, wide] of [['#ffffff', width + 3], [color, width]]) {
        [pen.strokeStyle, pen.lineWidth, pen.lineJoin] = [style, wide, 'round'];
        pen.beginPath();
        places.map(at).forEach(([x, y], i) => (i ? pen.lineTo(x, y) : pen.moveTo(x, y)));
        pen.stroke();
      }
    };
    const disc = (place, color) => {
      for (const [style, radius] of [['#ffffff', 10], [color, 7]]) {
        pen.fillStyle = style;
        pen.beginPath();
        pen.arc(...at(place), radius, 0, 2 * Math.PI);
        pen.fill();
      }
    };
    line(flight.flownUntil(time).map((point) => point.believed), '#4b5563', 3);
    line(flight.moments[shown].plan.map((point) => point.position), header.color, 4);
    disc(data.goal, '#a21caf');
    const {rows} = flight.robotAt(time, shown);
    disc([rows[3], rows[7]], '#111827');
  }

  function drawGrids() {
    const moment = shown;
    const obstacles = flight.latest('obstacles', shown), information = flight.latest('information', shown);
    decode(obstacles, (grid) => {
      if (moment === shown) drawGrid('obstacles', grid, (level) => kObstacleColors[level] || kObstacleColors[0]);
    });
    decode(information, (grid) => {
      if (moment !== shown) return;
      const levels = grid ? [...grid.levels].filter((level) => level !== kNoInformation) : [];
      const least = Math.max(1, Math.min(...levels)), largest = Math.max(least + 1, ...levels);
      drawGrid('information', grid, (level) => level === kNoInformation ? [122, 130, 140]
          : viridis((level - least) / (largest - least)));
      const trace = (level) => say(Number((10 ** (level / kLevelsPerDecade)).toPrecision(2)));
      element('information-scale').textContent = levels.length ? `${trace(least)} to ${trace(largest)}` : 'no view yet';
    });
  }

  // A moment -----------------------------------------------------------------------------------------
  function showImages() {
    for (const [id, part] of [['seen', 'observed'], ['expected', 'predicted']]) {
      const jpeg = flight.latest(part, shown);
      if (jpeg) element(id).src = `data:image/jpeg;base64,${jpeg}`;
    }
    const images = [element('seen'), element('expected')], sources = images.map(({src}) => src);
    Promise.all(images.map((image) => image.decode())).then(() => {
      if (images.every(({src}, i) => src === sources[i])) drawDifference(...images);
    }, () => {});  // replaced by the next ones, or none
  }

  function drawDifference(seen, expected) {
    const canvas = element('difference');
    [canvas.width, canvas.height] = [seen.naturalWidth, seen.naturalHeight];
    const pen = canvas.getContext('2d', {willReadFrequently: true});
    const [a, b] = [seen, expected].map((image) => {
      pen.drawImage(image, 0, 0, canvas.width, canvas.height);
      return pen.getImageData(0, 0, canvas.width, canvas.height);
    });
    for (let i = 0; i < a.data.length; i += 4)
      a.data.set(b.data[i] <= kNotPredicted ? kUnknownColor
          : viridis(Math.abs(a.data[i] - b.data[i]) / (255 * kFullDifference)), i);
    pen.putImageData(a, 0, 0);
  }

  function showNumbers() {
    const {update: u, robot} = flight.moments[shown];
    rows(element('flight-numbers'), [
      ['Update', `${shown + 1} of ${flight.moments.length}, at ${u.time.toFixed(1)}\u00a0s`],
      ['Way to go', u.length === null ? 'no way found' : say(u.length, 'm')],
      ['1σ of the position, worst direction', say(100 * worstSigma(robot.position_covariance), 'cm')],
      ['Vertices removed, added, rewired', [u.vertices_invalidated, u.vertices_added, u.vertices_rewired].map((n) => say(n)).join(', ')],
      ['Edges blocked', say(u.edges_invalidated)],
      ['Views marked, rendered', [u.views_marked, u.views_rendered].map((n) => say(n)).join(', ')],
      ['Fusion, clearance, planning', `${[u.fuse_s, u.clearance_s, u.plan_s].map((s) => (1000 * s).toFixed(0)).join(', ')}\u00a0ms`],
    ]);
  }

  function showState() {
    const end = flight.end;
    element('flight-state').textContent = end
        ? `${end.end}${end.reason ? `: ${end.reason}` : ''}` : flight.live ? 'flying' : 'connection lost';
    element('flight-state').className = end ? (end.end === 'arrived' ? 'good' : 'bad') : flight.live ? 'flying' : 'bad';
    element('flight-follow').hidden = !flight.live || following;
  }

  /// The flight as it was at a time.
  function show(wanted) {
    time = Math.max(0, Math.min(wanted, flight.duration));
    const slider = element('flight-time');
    slider.max = flight.duration;
    slider.value = time;
    element('flight-clock').textContent = `${time.toFixed(1)} of ${flight.duration.toFixed(1)}\u00a0s`;
    const index = Math.max(0, flight.momentAt(time));
    showState();
    if (!flight.moments.length) return;
    const isNew = index !== shown;
    shown = index;
    if (flight3d) {
      if (isNew) flight3d.showMoment(index);
      flight3d.showWay(flight.flownUntil(time));
      flight3d.showRobot(flight.robotAt(time, index));
    }
    if (isNew) {
      showImages();
      showNumbers();
    }
    drawGrids();
    charts.forEach((chart) => chart.draw());
    document.documentElement.dataset.moment = index;
  }

  // Charts ------------------------------------------------------------------------------------------
  const charts = [];
  const cursor = verticalLine(() => time, '--ink');
  const kParts = [['fusion', 'fuse_s', '#4477aa'], ['clearance', 'clearance_s', '#ccbb44'], ['planning', 'plan_s', '#ee6677']];

  function drawChart(id, type, datasets, yTitle, log, stacked) {
    const x = {...chartAxis('time [s]', false), type: 'linear', min: 0, max: Math.max(1, flight.duration), stacked};
    charts.push(new Chart(element(id), {
      type, data: {datasets}, plugins: [cursor],
      options: {
        animation: false, responsive: true, maintainAspectRatio: false, parsing: false, normalized: true,
        interaction: {mode: 'nearest', axis: 'x', intersect: false},
        elements: {point: {radius: 0, hitRadius: 8}, line: {borderWidth: 2.2}},
        scales: {x, y: {...chartAxis(yTitle, log), beginAtZero: !log, stacked}},
        plugins: {
          legend: {display: datasets.length > 1, align: 'start', labels: {boxWidth: 14, boxHeight: 6, color: cssColor('--ink')}},
          tooltip: {callbacks: {title: (items) => say(items[0].parsed.x, 's'), label: (item) => `${item.dataset.label}: ${say(item.parsed.y)}`}},
        },
        onClick: (event, _, chart) => jump(chart.scales.x.getValueForPixel(event.x)),
      },
    }));
  }

  function drawCharts() {
    charts.splice(0).forEach((chart) => chart.destroy());
    drawChart('flight-trace', 'line', [{
      label: 'trace of the belief', borderColor: flight.header.color, backgroundColor: flight.header.color,
      data: flight.flown.filter((point) => point.trace > 0).map((point) => ({x: point.time, y: point.trace})),
    }], 'trace [m²]', true, false);
    drawChart('flight-updates', 'bar', kParts.map(([label, key, color]) => ({
      label, backgroundColor: color, barThickness: 4,
      data: flight.moments.map(({update}) => ({x: update.time, y: 1000 * update[key]})),
    })), 'time of an update [ms]', false, true);
  }

  // Time --------------------------------------------------------------------------------------------
  function stop() {
    clearInterval(playing);
    playing = 0;
    element('flight-play').textContent = 'Play';
  }

  function jump(wanted) {
    stop();
    following = false;
    show(wanted);
  }

  function play() {
    if (playing) return stop();
    if (time >= flight.duration - 1e-6) time = 0;
    following = false;
    element('flight-play').textContent = 'Pause';
    let before = performance.now();
    const step = () => {
      const now = performance.now();
      const next = time + (now - before) / 1000 * Number(element('flight-speed').value);
      before = now;
      show(next);
      if (next >= flight.duration && !flight.live) stop();
    };
    playing = setInterval(step, 40);
  }

  // Live --------------------------------------------------------------------------------------------
  let chartTimer = 0;
  function grown() {
    if (following) show(flight.duration); else show(time);
    if (!chartTimer)
      chartTimer = setTimeout(() => {
        chartTimer = 0;
        drawCharts();
      }, 1000);
  }

  function listen() {
    const events = new EventSource('events');
    events.addEventListener('moment', (event) => {
      flight.add(JSON.parse(event.data));
      grown();
    });
    events.addEventListener('end', (event) => {
      events.close();
      flight.finish(JSON.parse(event.data));
      grown();
      showState();
    });
    events.addEventListener('error', () => {
      if (events.readyState === EventSource.CLOSED) flight.live = false;
      showState();
    });
  }

  element('flight').hidden = element('flight-charts').hidden = element('flight-bar').hidden = false;
  element('flight-time').addEventListener('input', (event) => jump(Number(event.target.value)));
  element('flight-play').addEventListener('click', play);
  element('flight-follow').addEventListener('click', () => {
    stop();
    following = true;
    show(flight.duration);
  });
  drawCharts();
  const wanted = Number((location.hash.match(/time=([0-9.]+)/) || [])[1]);
  show(wanted >= 0 ? wanted : flight.duration);
  if (flight.live) listen();
  return {
    redraw() {
      drawCharts();
      show(time);
    },
  };
}
