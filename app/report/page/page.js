// The page around view and charts.
'use strict';

// Waypoints ---------------------------------------------------------------------------------------
/// A cell that breaks its lines only between words, and never between a number and its unit; a long
/// word, as a path of a file, breaks anywhere.
function cell(content) {
  const text = String(content).replace(/(\d) (?=(?:1\/)?(?:[mkc]?m|m?s|Hz|deg|rad|m\/s|[%°])(?:[²³,;: )]|$))/g, '$1\u00a0');
  const node = make('td', text);
  if (/\S{24}/.test(text)) node.className = 'long';
  return node;
}

function rows(table, pairs) {
  table.replaceChildren(...pairs.map(([name, value]) => {
    const row = make('tr');
    row.append(make('th', name), cell(value));
    return row;
  }));
}

function showWaypoint(index) {
  const {point, view} = waypoints[index];
  element('waypoint-name').textContent = `${placeName} ${index} of ${waypoints.length - 1}`;
  element('waypoint').value = index;
  for (const kind of ['predicted', 'contribution']) {
    const uri = view && (kind === 'predicted' ? view.image : view.contribution);
    element(`${kind}-box`).hidden = !uri;
    if (uri) element(kind).src = uri;
  }
  const place = [
    ['Distance', say(point.distance, 'm')],
    ['Position x, y, z', `${point.position.map((x) => x.toFixed(2)).join(', ')}\u00a0m`.replace(/-/g, '−')],
  ];
  const sigma = [0, 4, 8].map((i) => say(100 * Math.sqrt(Math.max(0, point.position_covariance[i]))));
  const belief = [
    ['1σ in x, y, z', `${sigma.join(', ')}\u00a0cm`],
    ['1σ, worst direction', say(100 * worstSigma(point.position_covariance), 'cm')],
    ['Trace', say(point.trace, 'm²')],
  ];
  if (hasCost) belief.push(['Cost so far', say(point.cost)]);
  rows(element('waypoint-numbers'), hasBeliefs ? [...place, ...belief] : place);
  document.documentElement.dataset.waypoint = index;
}

// Playing -----------------------------------------------------------------------------------------

/// A button that plays and pauses what has a next step.
/// @param speed select with a factor  @param interval of steps at speed 1 [ms]
function createPlayer(button, speed, interval, {isAtEnd, next, rewind}) {
  let timer = 0;
  const stop = () => {
    clearInterval(timer);
    timer = 0;
    button.textContent = 'Play';
  };
  const start = () => {
    clearInterval(timer);
    button.textContent = 'Pause';
    timer = setInterval(() => {
      if (!isAtEnd()) next();
      if (isAtEnd()) stop();
    }, interval / Number(speed.value));
  };
  button.addEventListener('click', () => {
    if (timer) return stop();
    if (isAtEnd()) rewind();
    start();
  });
  speed.addEventListener('change', () => { if (timer) start(); });
  return {stop};
}

// Tables ------------------------------------------------------------------------------------------
function addTable(title, pairs) {
  if (!pairs.length) return;
  const box = make('div'), table = make('table', undefined, {className: 'numbers'});
  rows(table, pairs);
  box.append(make('h2', title), table);
  element('tables').append(box);
}

function addTextTable({title, head, rows, note}) {
  const box = make('div', undefined, {className: 'wide'}), table = make('table');
  const thead = make('thead'), body = make('tbody'), top = make('tr');
  top.append(...head.map((cell) => make('th', cell)));
  thead.append(top);
  body.append(...rows.map((cells) => {
    const row = make('tr');
    row.append(...cells.map(cell));
    return row;
  }));
  table.append(thead, body);
  box.append(make('h2', title), table, make('p', note, {className: 'note', hidden: !note}));
  element('tables').append(box);
}

function addComparison() {
  if (paths.length < 2 || !hasBeliefs || data.result.command === 'replay' || sweep) return;
  const box = make('div', undefined, {className: 'wide'}), table = make('table');
  const head = make('tr'), body = make('tbody');
  const shown = (columns) => columns.filter((_, i) => i !== 2 || hasCost);
  head.append(...shown(['Path', 'Length', 'Cost', 'Mean trace', 'Trace at the goal', '1σ at the goal']).map((t) => make('th', t)));
  const thead = make('thead');
  thead.append(head);
  paths.forEach((path, i) => {
    const s = summaries[i], row = make('tr'), name = make('td');
    const swatch = make('span', undefined, {className: 'swatch'});
    swatch.style.background = path.color;
    name.append(swatch, path.name);
    const cells = [name, say(s.length, 'm'), say(s.cost), say(s.meanTrace, 'm²'), say(s.goalTrace, 'm²'),
                   say(100 * s.goalSigma, 'cm')];
    row.append(...shown(cells).map((cell) => (cell === name ? name : make('td', cell))));
    body.append(row);
  });
  table.append(thead, body);
  box.append(make('h2', data.result.command === 'compare' ? 'First path of every method' : 'Paths compared'), table);
  element('tables').append(box);
}

function fillRest() {
  element('characteristic-length').textContent = data.result.characteristic_length ?? 1;
  const textTables = data.text_tables ?? [], isLong = ({rows}) => rows.length > 20;
  textTables.filter((table) => !isLong(table)).forEach(addTextTable);
  addComparison();
  addAllNumbers();
  for (const table of data.tables) addTable(table.title, table.rows);
  textTables.filter(isLong).forEach(addTextTable);
  for (const figure of data.figures) {
    const box = make('figure');
    const image = make('img', undefined, {src: figure.image, alt: figure.caption});
    image.addEventListener('load', () => box.classList.toggle('wide', image.naturalWidth > 1400));
    box.append(image, make('figcaption', figure.caption));
    element('figures').append(box);
  }
  element('config').textContent = data.config;
  element('config-box').hidden = !data.config;
  element('command').textContent = data.command_line;
  element('command-box').hidden = !data.command_line;
  element('footer').textContent = 'Made by photonav, with three.js and Chart.js (MIT licence). This file is complete: it needs no network.';
  for (const button of document.querySelectorAll('[data-copy]'))
    button.addEventListener('click', async () => {
      await navigator.clipboard.writeText(element(button.dataset.copy).textContent);
      button.textContent = 'Copied';
    });
}

// Everything together -----------------------------------------------------------------------------
let selected = -1, addressTimer = 0;

function select(index) {
  if (!(index >= 0 && index < waypoints.length) || index === selected) return;
  selected = index;
  showWaypoint(index);
  if (view3d) view3d.select(index);
  charts.select(index);
  if (frames) frames.follow(index);
  clearTimeout(addressTimer);  // browsers forbid many changes of the address in a row
  addressTimer = setTimeout(() => history.replaceState(null, '', `#waypoint=${index}`), 300);
}

function addLayerSwitches() {
  for (const [name, layer] of Object.entries(view3d.layers)) {
    const box = make('label'), chip = make('i');
    const input = make('input', undefined, {type: 'checkbox', checked: true});
    chip.style.setProperty('--chip', layer.color);
    input.addEventListener('change', () => view3d.show(name, input.checked));
    box.append(input, chip, layer.label);
    element('layers').append(box);
  }
}

function setUpExaggeration() {
  const factors = [1, 2, 5, 10, 20, 50, 100], slider = element('exaggeration');
  element('exaggeration-box').hidden = !hasBeliefs && !flight;
  slider.max = factors.length - 1;
  const apply = () => {
    const factor = factors[slider.value];
    view3d.setExaggeration(factor);
    if (flight3d) flight3d.setExaggeration(factor);
    if (frames) frames.setExaggeration(factor);
    element('exaggeration-value').textContent = factor === 1 ? 'true size' : `${factor} × larger`;
  };
  slider.value = factors.indexOf(flight ? 1 : view3d.suggestedExaggeration);
  slider.addEventListener('input', apply);
  apply();
}

/// Heights where the robot is, without paths those of start and goal. Recordings have neither.
function robotHeights() {
  if (flight) return [flight.header.box[1][2]];
  if (paths.length) return paths.flatMap((path) => path.points.map((point) => point.position[2]));
  return isRecorded ? [] : [data.start[2], data.goal[2]];
}

/// Ceilings hide what is below: the map is cut above the robot, or at three quarters of its height.
function setUpCut() {
  const slider = element('cut'), {min, max} = view3d.mapBox;
  element('cut-box').hidden = !(max.z - min.z > 0.05);
  if (element('cut-box').hidden) return;
  const heights = robotHeights();
  Object.assign(slider, {min: min.z, max: max.z + 0.01});
  slider.value = Math.min(max.z + 0.01, heights.length ? Math.max(...heights) + 0.3 : min.z + 0.75 * (max.z - min.z));
  const apply = () => {
    const height = Number(slider.value);
    view3d.setCut(height);
    element('cut-value').textContent = height >= max.z ? 'the top' : `z = ${height.toFixed(2)} m`.replace('-', '−');
  };
  slider.addEventListener('input', apply);
  apply();
}

function setUpView() {
  if (!view3d) {
    element('no-webgl').hidden = false;
    for (const id of ['scene', 'cameras', 'exaggeration-box', 'cut-box']) element(id).hidden = true;
    return;
  }
  addLayerSwitches();
  setUpExaggeration();
  setUpCut();
  element('perspective').addEventListener('click', view3d.views.perspective);
  element('top').addEventListener('click', view3d.views.top);
  element('scene-caption').textContent =
      (hasBeliefs ? `Paths with the 3σ ellipsoids of the ${isRecorded ? 'estimated' : 'predicted'} position` : paths.length ? 'Paths'
          : flight ? 'The map that the robot makes, its plan, and the path flown' : 'The map') +
      `, grid of ${say(view3d.gridStep, 'm')}. Drag to turn, right button or two fingers to move, ` +
      'wheel to zoom after a click.' +
      (waypoints.length ? ` Click a white ${placeName.toLowerCase()}, or use ← and →, to see ${data.views.length ? 'through the camera there' : 'its numbers'}.` : '');
}

/// Walks along the path, as a flight would.
function setUpWalk() {
  const player = createPlayer(element('walk'), element('walk-speed'), 250, {
    isAtEnd: () => selected + 1 >= waypoints.length,
    next: () => select(selected + 1),
    rewind: () => select(0),
  });
  for (const id of ['waypoint', 'previous', 'next'])
    element(id).addEventListener(id === 'waypoint' ? 'input' : 'click', player.stop);
}

function setUpWaypoints() {
  element('panel').hidden = !waypoints.length;
  element('stage').classList.toggle('alone', !waypoints.length && !flight);
  element('stage').classList.toggle('watched', flight !== null);
  if (!waypoints.length) return;
  element('waypoint').max = waypoints.length - 1;
  element('waypoint').addEventListener('input', (event) => select(Number(event.target.value)));
  element('previous').addEventListener('click', () => select(selected - 1));
  element('next').addEventListener('click', () => select(selected + 1));
  setUpWalk();
  addEventListener('keydown', (event) => {
    if (event.target.tagName === 'INPUT' || event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.key === 'ArrowLeft') select(selected - 1);
    if (event.key === 'ArrowRight') select(selected + 1);
  });
  const fromHash = () => select(Number((location.hash.match(/waypoint=(\d+)/) || [])[1]));
  addEventListener('hashchange', fromHash);
  fromHash();
  if (selected < 0) select(frames?.place() ?? -1);
  if (selected < 0) select(Math.floor(waypoints.length / 2));
}

function redrawCharts() {
  charts.drawAll(element('trace-log').checked);
  if (chosenPath >= 0) charts.choose(chosenPath);
}

fillHead();
fillTiles();
fillCost();
fillSweep();
fillRest();
element('panel').hidden = !waypoints.length;
const view3d = createView3d(element('scene'), select);
const charts = createCharts(select);
element('trace-log').checked = paths.length > 0;
element('trace-log').addEventListener('change', redrawCharts);
charts.drawAll(element('trace-log').checked);
const flight3d = flight && view3d ? createFlight3d(view3d, flight) : null;
const frames = createFrames(view3d, select);
setUpView();
setUpWaypoints();
const chooseAlpha = (index) => {
  if (view3d) view3d.choose(index);
  charts.choose(index);
};
setUpAlpha(chooseAlpha);
const flightPanel = flight ? createFlightPanel(flight3d) : null;
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
  redrawCharts();
  if (sweepCharts.length) drawSweepCharts();
  if (view3d) view3d.drawGround();
  if (flightPanel) flightPanel.redraw();
});
