// The run as it was written into the page, unpacked, and how its numbers are said.
'use strict';

const data = JSON.parse(document.getElementById('data').textContent);

function bytesOf(base64) {
  return Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
}
const floatsOf = (base64) => new Float32Array(bytesOf(base64).buffer);
const indicesOf = (base64) => new Uint32Array(bytesOf(base64).buffer);

const superscript = (n) => String(n).replace(/[-0-9]/g, (c) => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(c)]);

/// Four significant digits, powers of ten where they read better.
function say(value, unit = '') {
  if (typeof value !== 'number' || !isFinite(value)) return '–';
  const size = Math.abs(value);
  let text;
  if (Number.isInteger(value)) {
    text = size < 1e15 ? value.toLocaleString('en').replace(/,/g, '\u202f') : value.toExponential(3);
  } else if (size < 1e-3 || size >= 1e6) {
    const [digits, exponent] = value.toExponential(2).split('e');
    text = `${digits}\u202f×\u202f10${superscript(Number(exponent))}`;
  } else {
    text = value.toFixed(Math.max(0, Math.min(4, 2 - Math.floor(Math.log10(size)))));
  }
  return (unit ? `${text}\u00a0${unit}` : text).replace('-', '−');
}

/// Standard deviation of the position [m] along its worst direction: the root of the largest
/// eigenvalue, by power iteration.
function worstSigma(covariance) {
  let v = [0.6, 0.7, 0.4], length = 0;
  for (let i = 0; i < 60; ++i) {
    const w = [0, 1, 2].map((r) => v.reduce((sum, x, c) => sum + covariance[3 * r + c] * x, 0));
    length = Math.hypot(...w);
    if (!(length > 0)) return 0;
    v = w.map((x) => x / length);
  }
  return Math.sqrt(length);
}

/// The key numbers of a path. Points are too far apart to give the mean trace, which the run wrote.
function summaryOf({points, mean_trace: meanTrace = null}) {
  const last = points[points.length - 1];
  return {
    length: last.distance,
    cost: last.cost,
    meanTrace,
    goalTrace: last.trace,
    goalSigma: worstSigma(last.position_covariance),
  };
}

const paths = data.paths.filter((path) => path.points.length > 0);
const summaries = paths.map(summaryOf);

/// A recorded trajectory is a path without beliefs.
const hasBeliefs = paths.some((path) => path.points.some((point) => point.trace > 0));
const hasCost = summaries.some((path) => path.cost > 0);

/// Paths that were recorded, not planned: they have frames and no goal.
const isRecorded = ['map', 'replay'].includes(data.result.command);
const placeName = isRecorded ? 'Frame' : 'Waypoint';

/// The points that can be selected: those with a predicted view, or all if there are none. The paths
/// of a sweep are only drawn.
const waypoints = !paths.length || data.result.command === 'sweep' ? [] : data.views.length
    ? data.views.map((view) => ({point: paths[0].points[view.point], index: view.point, view}))
    : paths[0].points.map((point, index) => ({point, index, view: null}));

const cssColor = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
