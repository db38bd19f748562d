// All numbers of a result: in groups, in words and with units.
'use strict';

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
    if (path === 'interrupted' && !value) return [];
    if (isList && (value.length > 6 || value.some((x) => typeof x === 'object'))) return [];
    return typeof value === 'object' && !isList ? leaves(value, `${path}.`) : [[path, value]];
  });
}

/// Group of a path, and its key there.
function placeOf(path, groups) {
  const [top, ...below] = path.split('.'), key = below.length ? below.join('.') : top;
  const listed = Object.keys(groups).find((title) => groups[title].includes(path));
  return [listed ?? (below.length ? kTitles[top] ?? inWords(top) : 'Result'), key];
}

/// Titles and rows of a result. @return Map from a title to [label, value] pairs
function numberGroups(result) {
  const groups = kGroups[result.command] ?? {}, order = Object.values(groups).flat();
  const rank = ([path]) => (order.includes(path) ? order.indexOf(path) : order.length + path.includes('.'));
  const found = new Map();
  for (const [path, value] of leaves(result).sort((a, b) => rank(a) - rank(b))) {
    const [title, key] = placeOf(path, groups), [label, unit] = labelAndUnit(key, path);
    found.set(title, [...(found.get(title) ?? []), [label, sayValue(value, unit)]]);
  }
  return found;
}

function addAllNumbers() {
  const box = make('details', undefined, {className: 'wide'}), columns = make('div', undefined, {className: 'columns'});
  for (const [title, pairs] of numberGroups(data.result)) {
    const group = make('div'), table = make('table', undefined, {className: 'numbers'});
    rows(table, pairs);
    group.append(make('h3', title), table);
    columns.append(group);
  }
  if (!columns.childElementCount) return;
  box.append(make('summary', 'All numbers'), columns);
  element('tables').append(box);
}
