// What the page begins with: title, verdict and key numbers of the run.
'use strict';

const element = (id) => document.getElementById(id);

function make(tag, text, attributes = {}) {
  const node = document.createElement(tag);
  if (text !== undefined) node.textContent = text;
  return Object.assign(node, attributes);
}

function verdict() {
  if (sweep) return sweepVerdict();
  if (data.result.command === 'fly') return flyVerdict();
  if (data.result.command === 'explore') return exploreVerdict(data.result);
  if (data.result.command === 'servo') return servoVerdict(data.result);
  if (data.result.verdict) return `${data.result.verdict[0].toUpperCase()}${data.result.verdict.slice(1)}.`;
  if (!paths.length) return data.result.command === 'plan' ? 'No path was found.' : '';
  if (!hasBeliefs) return '';
  // compare: with the last one, the shortest path.
  const isComparison = data.result.command === 'compare', rival = isComparison ? paths.length - 1 : 1;
  const ours = summaries[0], other = rival > 0 && summaries[rival];
  if (!other)
    return `The path is ${say(ours.length, 'm')} long and ends with a predicted position error of ` +
           `${say(100 * ours.goalSigma, 'cm')} (1σ, worst direction).`;
  const percent = Math.round(100 * (ours.length / other.length - 1));
  const length = percent === 0 ? `as long, ${say(ours.length, 'm')}`
      : `${say(ours.length, 'm')} long instead of ${say(other.length, 'm')} ` +
        `(${percent > 0 ? '+' : '−'}${Math.abs(percent)} %)`;
  const goal = `the predicted position error at the goal is ${say(100 * ours.goalSigma, 'cm')} instead of ` +
      `${say(100 * other.goalSigma, 'cm')} (1σ, worst direction)${factorOf(ours.goalSigma, other.goalSigma)}`;
  // What the planner lowers is the uncertainty along the path; the one at the goal may be as large.
  const mean = ours.goalSigma < other.goalSigma && differs(ours.goalSigma, other.goalSigma) ? ''
      : `, the mean trace along the path is ${say(ours.meanTrace)} instead of ${say(other.meanTrace, 'm²')}` +
        factorOf(ours.meanTrace, other.meanTrace);
  const name = isComparison ? ` of ${paths[0].name}` : '';
  return `Compared with ${paths[rival].name}, the path${name} is ${length}${mean}, and ${goal}.`;
}

/// Whether two numbers differ by more than a twentieth.
const differs = (a, b) => Math.max(a, b) > 1.05 * Math.min(a, b);

/// ": 2.5 times smaller"; nothing for numbers that hardly differ.
function factorOf(ours, other) {
  const ratio = other / ours;
  return !(ratio > 0 && isFinite(ratio) && differs(ours, other)) ? ''
      : ratio > 1 ? `: ${ratio.toPrecision(2)} times smaller` : `: ${(1 / ratio).toPrecision(2)} times larger`;
}

/// Actual and predicted errors of the flights.
function flyVerdict() {
  const flown = ({planner, flights, arrived, position_rmse_m: error, predicted_sigma_m: predicted,
                  nees_per_dof: nees}) => !flights ? `${planner} was not flown`
      : `${planner}: ${arrived} of ${flights} flights arrived, with a position error of ` +
        `${say(100 * error, 'cm')} rms (predicted ${say(100 * predicted, 'cm')}; NEES ${say(nees)})`;
  const {planners} = data.result;
  return planners.length ? `${planners.map(flown).join('; ')}.` : 'No path was found.';
}

/// How the first flight ended.
function exploreVerdict(r) {
  if (!r.end) return '';
  const how = r.arrived ? 'The robot arrived' : `The robot did not arrive (${r.reason || r.end})`;
  return `${how}: ${say(r.length, 'm')} flown in ${say(r.duration_s, 's')}, ` +
         `with a position error of ${say(times(100, r.position_rmse_m), 'cm')} rms (NEES ${say(r.nees_per_dof)}; 1 if consistent).`;
}

const sumOf = (cells, key) => cells.reduce((total, cell) => total + cell[key], 0);

/// From where the servo converges, and how fast.
function servoVerdict({basin = [], modes = []}) {
  if (!basin.length) return '';
  const slowest = modes[0]?.rate_per_s > 0 ? `, and small offsets in the slowest direction (${modes[0].in_words}) ` +
      `decay with a time constant of ${say(1 / modes[0].rate_per_s, 's')}` : '; the view leaves a direction open';
  return `${say(sumOf(basin, 'converged'))} of ${say(sumOf(basin, 'trials'))} starts converge to the goal’s view${slowest}.`;
}

function fillHead() {
  document.title = `${data.title} – photonav`;
  element('brand').textContent = ['photonav', data.version, data.result.command].filter(Boolean).join(' · ');
  element('title').textContent = data.title;
  element('subtitle').textContent = data.subtitle;
  element('verdict').textContent = verdict();
  element('verdict').hidden = !verdict();
}

function replayTiles({ate_rmse_m: ate, rpe, nees_per_dof: nees, tracked, frames, lost,
  fps_with_reading: fps}) {
  const second = rpe.second || rpe.frame || {}, over = rpe.second ? 'a second' : 'a frame';
  return [
    ['frames tracked', tracked, `of ${frames}`], ['frames lost', lost, ''],
    ['absolute error, rms', times(1000, ate), 'mm'],
    [`position error over ${over}, rms`, 1000 * second.translation_m, 'mm'],
    [`rotation error over ${over}, rms`, second.rotation_deg, '°'],
    ['NEES per degree of freedom (1: consistent)', nees, ''], ['frames per second, with reading', fps, ''],
  ];
}

/// A number times a factor, but null stays null.
const times = (factor, value) => (value === null ? null : factor * value);

function flyTiles({planners}) {
  return planners.flatMap((flown) => [
    [`${flown.planner}: arrived`, flown.arrived, `of ${flown.flights}`],
    ['position error, rms', times(100, flown.position_rmse_m), 'cm'],
    ['predicted, 1σ', times(100, flown.predicted_sigma_m), 'cm'],
    ['NEES per degree of freedom (1: consistent)', flown.nees_per_dof, ''],
  ]);
}

function servoTiles({basin = [], modes = [], position_sigma_m: position, rotation_sigma_rad: rotation, condition, time}) {
  return [
    ['starts that converge', sumOf(basin, 'converged'), `of ${sumOf(basin, 'trials')}`],
    ['time constant, slowest direction', modes[0]?.rate_per_s > 0 ? 1 / modes[0].rate_per_s : null, 's'],
    ['position from one image, 1σ', times(1000, position), 'mm'],
    ['rotation from one image, 1σ', times(180 / Math.PI, rotation), '°'],
    ['condition of the Hessian', condition, ''], ['computing time', time?.total_s, 's'],
  ];
}

function exploreTiles(r) {
  return [
    ['path flown', r.length, 'm'], ['time of flight', r.duration_s, 's'],
    ['position error, rms', times(100, r.position_rmse_m ?? null), 'cm'],
    ['NEES per degree of freedom (1: consistent)', r.nees_per_dof, ''],
    ['true distance to the goal', times(100, r.goal_error_m ?? null), 'cm'],
    ['keyframes', r.keyframes, ''], ['updates of the plan', r.updates?.length, ''],
    ['median update', (r.summary || [])[0]?.update_median_ms, 'ms'],
  ];
}

function fillTiles() {
  const {result} = data, ours = hasBeliefs ? summaries[0] : {};
  const seconds = (result.time || {}).total_s;
  const tiles = sweep ? sweepTiles() : result.command === 'replay' ? replayTiles(result)
      : result.command === 'fly' ? flyTiles(result)
      : result.command === 'servo' ? servoTiles(result)
      : result.command === 'explore' ? exploreTiles(result) : [
    ['path length', ours.length ?? result.length, 'm'],
    ['goal position, 1σ', 100 * ours.goalSigma, 'cm'],
    ['goal trace', ours.goalTrace ?? result.goal_trace, 'm²'],
    ['mean trace', ours.meanTrace ?? result.mean_trace, 'm²'],
    ['cost', hasCost ? ours.cost : result.cost, ''],
    ['vertices', result.vertices, ''],
    ['views predicted', result.views, ''],
    [result.command === 'plan' ? 'planning time' : 'computing time', seconds, 's'],
  ];
  for (const [name, value, unit] of tiles) {
    if (typeof value !== 'number' || !isFinite(value)) continue;
    const tile = make('div', undefined, {className: 'tile'});
    const number = make('b', say(value));
    if (unit) number.append(make('small', unit));
    tile.append(number, make('span', name));
    element('tiles').append(tile);
  }
}
