// The page of a sweep: curves over alpha, and a table per planner.
'use strict';

const sweep = data.result.command === 'sweep' ? data.result : null;

const plannerColor = (planner) => data.planner_colors[planner];
const cellsOf = (planner) => sweep.summary.filter((cell) => cell.planner === planner);
const isNumber = (value) => typeof value === 'number' && isFinite(value);

function sweepVerdict() {
  const solved = cellsOf(sweep.planners[0]).filter((cell) => cell.solved);
  if (!solved.length) {
    const failed = sweep.runs.find((run) => run.status !== 'done');
    return failed ? `${failed.planner}: ${failed.status}.` : 'No run was finished.';
  }
  const cells = solved.sort((a, b) => a.alpha - b.alpha), first = cells[0], last = cells[cells.length - 1];
  const at = (cell) => `${say(cell.length_mean, 'm')} with a mean trace of ${say(cell.mean_trace_mean, 'm²')} ` +
                       `at alpha ${cell.alpha}`;
  const excess = sweep.planners.flatMap((planner) => {
    const known = cellsOf(planner).filter((cell) => isNumber(cell.excess_mean));
    const mean = known.reduce((sum, cell) => sum + cell.excess_mean, 0) / known.length;
    return known.length ? [`${planner} ${say(100 * mean)} %`] : [];
  });
  return `${sweep.planners[0]}: ${at(first)}` + (cells.length > 1 ? `, ${at(last)}.` : '.') +
         (excess.length ? ` Above the best cost known, on average: ${excess.join(', ')}.` : '');
}

function sweepTiles() {
  const seconds = sweep.runs.reduce((sum, run) => sum + run.seconds, 0);
  return [
    ['runs', sweep.runs_done, sweep.runs_done < sweep.runs_asked ? `of ${sweep.runs_asked}` : ''],
    ['planners', sweep.planners.length, ''],
    ['values of alpha', sweep.alphas.length, ''],
    ['seeds', sweep.runs_per_cell, ''],
    ['planning, all runs', seconds, 's'],
  ];
}

// One alpha -----------------------------------------------------------------------------------------

let chosenPath = -1;  // index in `paths`, which are those of the first planner by alpha

const alphaOf = (path) => Number(path.name.replace('alpha ', ''));

/// A ring around the point of the chosen alpha.
const chosenPoint = {
  id: 'chosenPoint',
  afterDatasetsDraw(chart) {
    if (!paths[chosenPath]) return;
    const {ctx, scales: {x, y}} = chart, curve = chart.data.datasets.find(({label}) => label === sweep.planners[0]);
    const point = curve && curve.data.find(({alpha}) => alpha === alphaOf(paths[chosenPath]));
    if (!point) return;
    ctx.save();
    ctx.strokeStyle = cssColor('--ink');
    ctx.lineWidth = 2;
    ctx.beginPath();
    ctx.arc(x.getPixelForValue(point.x), y.getPixelForValue(point.y), 8, 0, 2 * Math.PI);
    ctx.stroke();
    ctx.restore();
  },
};

function describeChosen() {
  const s = summaries[chosenPath], run = cheapestRun(alphaOf(paths[chosenPath]));
  return `${alphaOf(paths[chosenPath])}: ${say(run.length, 'm')}, mean trace ${say(run.mean_trace, 'm²')}, ` +
         `${say(100 * s.goalSigma, 'cm')} at the goal (1σ, worst direction)`;
}

const cheapestRun = (alpha) => sweep.runs
    .filter((run) => run.planner === sweep.planners[0] && run.alpha === alpha && run.status === 'done')
    .reduce((best, run) => run.cost < best.cost ? run : best);

/// The slider that chooses one of the paths. @param onChoose called with its index
function setUpAlpha(onChoose) {
  const slider = element('alpha');
  element('alpha-bar').hidden = !sweep || !paths.length;
  if (element('alpha-bar').hidden) return;
  slider.max = paths.length - 1;
  const choose = (index) => {
    chosenPath = slider.value = index;
    slider.setAttribute('aria-valuetext', element('alpha-value').textContent = describeChosen());
    document.documentElement.dataset.alpha = alphaOf(paths[index]);
    onChoose(index);
    for (const chart of sweepCharts) chart.draw();
  };
  slider.addEventListener('input', () => choose(Number(slider.value)));
  choose(0);
}

// Curves ------------------------------------------------------------------------------------------

/// One standard deviation up and down.
const whiskers = {
  id: 'whiskers',
  afterDatasetsDraw(chart) {
    const {ctx, scales: {x, y}, chartArea: area} = chart;
    ctx.save();
    ctx.beginPath();
    ctx.rect(area.left, area.top, area.right - area.left, area.bottom - area.top);
    ctx.clip();
    chart.data.datasets.forEach((dataset, i) => {
      if (!chart.isDatasetVisible(i)) return;
      ctx.strokeStyle = dataset.borderColor;
      ctx.lineWidth = 1.5;
      for (const point of dataset.data) {
        if (!(point.deviation > 0)) continue;
        const at = x.getPixelForValue(point.x);
        const low = point.y - point.deviation;
        const bottom = low > 0 || y.type !== 'logarithmic' ? y.getPixelForValue(low) : area.bottom;
        ctx.beginPath();
        ctx.moveTo(at, bottom);
        ctx.lineTo(at, y.getPixelForValue(point.y + point.deviation));
        ctx.stroke();
      }
    });
    ctx.restore();
  },
};

const sweepCharts = [];

/// An axis that holds the whiskers, too; below zero a logarithmic one cannot.
function valueAxis(title, log, datasets) {
  const points = datasets.flatMap((dataset) => dataset.data);
  const ends = points.flatMap((p) => [p.y - (p.deviation || 0), p.y + (p.deviation || 0)]).filter((y) => !log || y > 0);
  if (!ends.length) return chartAxis(title, log);
  return {...chartAxis(title, log), suggestedMin: Math.min(...ends), suggestedMax: Math.max(...ends)};
}

function drawSweepChart(id, datasets, xTitle, yTitle, log) {
  sweepCharts.push(new Chart(element(id), {
    type: 'line',
    data: {datasets},
    plugins: [whiskers, chosenPoint],
    options: {
      animation: false, responsive: true, maintainAspectRatio: false, parsing: false, normalized: true,
      interaction: {mode: 'nearest', intersect: false},
      scales: {x: chartAxis(xTitle, false), y: valueAxis(yTitle, log, datasets)},
      plugins: {
        legend: {align: 'start', labels: {boxWidth: 14, boxHeight: 2, color: cssColor('--ink')}},
        tooltip: {callbacks: {
          title: (items) => `alpha ${items[0].raw.alpha}`,
          label: ({dataset, raw, parsed}) =>
            `${dataset.label}: ${say(parsed.y)}` + (raw.deviation > 0 ? ` ± ${say(raw.deviation)}` : ''),
        }},
      },
    },
  }));
}

/// A curve per planner and the paper's points. `x` and `y` name columns of the summary.
function sweepCurves(x, y) {
  const curve = (label, color, data, line) => ({
    label, data, borderColor: color, backgroundColor: color, borderWidth: 2.2, showLine: line,
    pointRadius: line ? 3.5 : 4.5, pointStyle: line ? 'circle' : 'rectRot',
  });
  const isAlpha = x === 'alpha';
  const point = (cell, px, py, deviation) => ({x: px, y: py, deviation, alpha: cell.alpha});
  const curves = sweep.planners.map((planner) => curve(planner, plannerColor(planner),
    cellsOf(planner).filter((cell) => isNumber(cell[`${y}_mean`])).sort((a, b) => a.alpha - b.alpha)
        .map((cell) => point(cell, isAlpha ? cell.alpha : cell[`${x}_mean`], cell[`${y}_mean`],
                             isAlpha ? cell[`${y}_std`] : 0)), true));
  const paper = sweep.summary.filter((cell) => isNumber(cell[`paper_${y}`]))
      .map((cell) => point(cell, isAlpha ? cell.alpha : cell[`paper_${x}`], cell[`paper_${y}`], 0));
  return paper.length ? [...curves, curve('paper', cssColor('--ink'), paper, false)] : curves;
}

function drawSweepCharts() {
  sweepCharts.splice(0).forEach((chart) => chart.destroy());
  drawSweepChart('length-chart', sweepCurves('alpha', 'length'), 'alpha', 'length [m]', false);
  drawSweepChart('mean-chart', sweepCurves('alpha', 'mean_trace'), 'alpha', 'mean trace [m²]', true);
  drawSweepChart('goal-chart', sweepCurves('alpha', 'goal_trace'), 'alpha', 'trace at the goal [m²]', true);
  drawSweepChart('front-chart', sweepCurves('length', 'mean_trace'), 'length [m]', 'mean trace [m²]', true);
}

// Tables ------------------------------------------------------------------------------------------
const traceDecimals = sweep ? sweep.trace_decimals : 4;

const sweepColumns = [
  ['J', 'cost', 3], ['length [m]', 'length', 2, 'paper_length'],
  ['mean trace [m²]', 'mean_trace', traceDecimals, 'paper_mean_trace'],
  ['goal trace [m²]', 'goal_trace', traceDecimals, 'paper_goal_trace'],
  ['excess [%]', 'excess', 2, null, 100], ['vertices', 'vertices', 0], ['views', 'views', 0], ['seconds', 'seconds', 2],
].filter(([, key]) => !sweep || sweep.summary.some((cell) => isNumber(cell[`${key}_mean`])));

function meanAndDeviation(cell, key, decimals, scale) {
  const mean = cell[`${key}_mean`], deviation = cell[`${key}_std`];
  if (!isNumber(mean)) return '–';
  const text = (scale * mean).toFixed(decimals).replace('-', '−');
  return deviation > 0 ? `${text} ± ${(scale * deviation).toFixed(decimals)}` : text;
}

function plannerTable(planner) {
  const table = make('table'), thead = make('thead'), body = make('tbody'), head = make('tr');
  const hasPaper = (key) => key && cellsOf(planner).some((cell) => isNumber(cell[key]));
  head.append(make('th', 'alpha'));
  for (const [title, , , paper] of sweepColumns)
    head.append(make('th', title), ...(hasPaper(paper) ? [make('th', 'paper')] : []));
  head.append(make('th', 'paths'));
  for (const cell of cellsOf(planner)) {
    const row = make('tr');
    row.append(make('td', String(cell.alpha)));
    for (const [, key, decimals, paper, scale = 1] of sweepColumns) {
      row.append(make('td', meanAndDeviation(cell, key, decimals, scale)));
      if (hasPaper(paper))
        row.append(make('td', isNumber(cell[paper]) ? (scale * cell[paper]).toFixed(decimals) : '', {className: 'quiet'}));
    }
    row.append(make('td', `${cell.solved} of ${cell.runs}`));
    body.append(row);
  }
  thead.append(head);
  table.append(thead, body);
  const box = make('div', undefined, {className: 'wide'}), title = make('h2'), swatch = make('span', undefined, {className: 'swatch'});
  swatch.style.background = plannerColor(planner);
  title.append(swatch, planner);
  const seeds = sweep.runs_per_cell;
  const note = seeds > 1 ? `Mean ± standard deviation over ${seeds} seeds.` : 'One seed: there is no standard deviation.';
  box.append(title, table, make('p', note, {className: 'note'}));
  return box;
}

function failuresTable() {
  const failed = sweep.runs.filter((run) => run.status !== 'done');
  if (!failed.length) return [];
  const box = make('div', undefined, {className: 'wide'}), table = make('table', undefined, {className: 'numbers'});
  rows(table, failed.slice(0, 100).map((run) => [`${run.planner}, alpha ${run.alpha}, seed ${run.seed}`, run.status]));
  box.append(make('h2', `Runs without a path: ${failed.length}`), table);
  return [box];
}

function fillSweep() {
  element('sweep-charts').hidden = !sweep || !sweep.summary.some((cell) => cell.solved);
  if (!sweep) return;
  element('sweep-tables').append(...sweep.planners.filter((planner) => cellsOf(planner).length).map(plannerTable),
                                 ...failuresTable());
  if (!element('sweep-charts').hidden) drawSweepCharts();
}
