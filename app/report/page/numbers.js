// All numbers of a result: in groups, in words and with units.
'use strict';

/// What stands elsewhere on the page, and explanations for readers of result.json.
const kShownElsewhere = ['config', 'schema', 'path', 'command', 'version', 'verdict', 'covariance_frame', 'directions_are'];

const kPathKeys = ['length', 'metric_length', 'cost', 'length_share', 'uncertainty_share', 'mean_trace', 'goal_trace'];

/// The groups of a plan, with their keys in order. Other results are grouped by their objects.
const kPlanGroups = {
  'Path': kPathKeys,
  'RRT*’s path (baseline)': kPathKeys.map((key) => `baseline.${key}`).concat('baseline.planner'),
  'Search': ['status', 'vertices', 'iterations', 'views', 'cache_hits', 'planner_cost', 'second_order_fallbacks'],
  'Time': ['time.total_s', 'time.views_s', 'time.beliefs_s', 'time.tree_s'],
  'Settings': ['planner', 'information', 'space', 'alpha', 'kappa', 'kappa_is_automatic', 'characteristic_length', 'seed'],
  'Check': ['audit.beliefs', 'audit.max_cost_error', 'audit.max_covariance_error'],
};

/// Label and unit of keys whose own words do not say enough.
const kNames = {
  metric_length: ['Length with rotations counted', 'm'], length_share: ['Share of the length in the cost', '%'],
  uncertainty_share: ['Share of the uncertainty in the cost', '%'],
  goal_trace: ['Trace at the goal', 'm²'], trace_before_view: ['Trace before the view', 'm²'],
  views: ['Views predicted', ''], cache_hits: ['Views taken from the cache', ''],
  planner_cost: ['Cost in the planner’s own model', ''],
  second_order_fallbacks: ['Second order in place of the fourth', ''],
  total_s: ['In total, without this report', 's'], views_s: ['Predicting views', 's'],
  beliefs_s: ['Propagating beliefs', 's'], tree_s: ['Growing the tree', 's'],
  information: ['Information model', ''], space: ['State space', ''],
  alpha: ['Alpha (1: only length counts)', ''], kappa: ['Kappa', '1/m²'], kappa_is_automatic: ['Kappa chosen automatically', ''],
  seed: ['Seed of the random numbers', ''], image_rate: ['Image rate', 'Hz'],
  max_cost_error: ['Largest error of a cost', ''], max_covariance_error: ['Largest error of a covariance', 'm²'],
  'audit.beliefs': ['Beliefs computed again', ''],
  lost_m: ['Length on which the camera is lost', 'm'], lost_s: ['Time without tracking', 's'],
  rejected_images_m: ['Length with rejected images', 'm'], open_directions_m: ['Length with open directions', 'm'],
};

/// Units of ends of keys. An end with an underscore is no part of the label.
const kUnits = {
  _s: 's', _per_s: '1/s', _ms: 'ms', _m: 'm', _cm: 'cm', _m2: 'm²', _mps: 'm/s', _rad: 'rad', _deg: '°', _degrees: '°',
  length: 'm', distance: 'm', resolution: 'm', range: 'm', position: 'm', trace: 'm²', yaw: 'rad',
};

const kWords = {
  nees: 'NEES', ate: 'ATE', rpe: 'RPE', rmse: 'RMS error', std: 'standard deviation', dof: 'degree of freedom',
  fps: 'frames per second', p90: '90th percentile of',
  xyz: 'position', 'xyz_yaw': 'position and heading', se3: 'position and rotation',
};

function inWords(key) {
  const text = key.split(/[._]/).map((word) => kWords[word] ?? word).join(' ');
  return text[0].toUpperCase() + text.slice(1);
}

/// @param key within its group, as "worst.trace" or "trace"  @param path from the top
function labelAndUnit(key, path) {
  const known = kNames[path] ?? kNames[key];
  if (known) return known;
  const end = Object.keys(kUnits).filter((suffix) => key.endsWith(suffix)).pop();
  const label = end?.startsWith('_') ? key.slice(0, -end.length) : key;
  return [inWords(label), kUnits[end] ?? ''];
}

/// Short numbers as they are: they were typed by someone.
const sayExactly = (value, unit) => String(value).length > 6 || Number.isInteger(value) ? say(value, unit)
    : `${value}${unit && '\u00a0'}${unit}`.replace('-', '−');

function sayValue(value, unit) {
  if (Array.isArray(value) && !value.length) return 'none';
  if (Array.isArray(value)) return value.map((x) => sayValue(x, '')).join(', ') + (unit && `\u00a0${unit}`);
  if (typeof value === 'boolean') return value ? 'yes' : 'no';
  if (typeof value === 'number') return unit === '%' ? say(100 * value, unit) : sayExactly(value, unit);
  return kWords[value] ?? value;
}

/// Paths and values of the numbers and words of a result, but for long lists.
function leaves(object, prefix = '') {
  return Object.entries(object).flatMap(([key, value]) => {
    const path = prefix + key, isList = Array.isArray(value);
    if (value === null || value === '' || kShownElsewhere.includes(path)) return [];
    if (isList && (value.length > 6 || value.some((x) => typeof x === 'object'))) return [];
    return typeof value === 'object' && !isList ? leaves(value, `${path}.`) : [[path, value]];
  });
}

/// Group of a path, and its key there.
function placeOf(path, groups) {
  const [top, ...below] = path.split('.'), key = below.length ? below.join('.') : top;
  const listed = Object.keys(groups).find((title) => groups[title].includes(path));
  return [listed ?? (below.length ? inWords(top) : 'Result'), key];
}

/// Titles and rows of a result. @return Map from a title to [label, value] pairs
function numberGroups(result) {
  const groups = result.command === 'plan' ? kPlanGroups : {}, order = Object.values(groups).flat();
  const rank = ([path]) => (order.includes(path) ? order.indexOf(path) : order.length + path.includes('.'));
  const found = new Map();
  for (const [path, value] of leaves(result).sort((a, b) => rank(a) - rank(b))) {
    const [title, key] = placeOf(path, groups), [label, unit] = labelAndUnit(key, path);
    found.set(title, [...(found.get(title) ?? []), [label, sayValue(value, unit)]]);
  }
  return found;
}

function addAllNumbers() {
  const box = make('div', undefined, {className: 'wide'}), columns = make('div', undefined, {className: 'columns'});
  for (const [title, pairs] of numberGroups(data.result)) {
    const group = make('div'), table = make('table', undefined, {className: 'numbers'});
    rows(table, pairs);
    group.append(make('h3', title), table);
    columns.append(group);
  }
  if (!columns.childElementCount) return;
  box.append(make('h2', 'All numbers'), columns);
  element('tables').append(box);
}
