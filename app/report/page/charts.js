// Curves along the path and of the search.
'use strict';

function isDecade(value) {
  const exponent = Math.log10(value);
  return Math.abs(exponent - Math.round(exponent)) < 1e-6;
}

/// On a logarithmic axis only decades are labelled, unless there are fewer than two.
function chartAxis(title, log) {
  return {
    type: log ? 'logarithmic' : 'linear',
    title: {display: true, text: title, color: cssColor('--quiet')},
    grid: {color: cssColor('--rule')},
    ticks: {
      color: cssColor('--quiet'),
      maxRotation: 0,
      callback: (value, _, ticks) => {
        if (!log) return String(Number(value.toPrecision(6))).replace('-', '−');
        if (isDecade(value)) return `10${superscript(Math.round(Math.log10(value)))}`;
        if (ticks.filter((tick) => isDecade(tick.value)).length > 1) return '';
        const exponent = Math.floor(Math.log10(value));
        return `${Number((value / 10 ** exponent).toPrecision(3))}·10${superscript(exponent)}`;
      },
    },
  };
}

/// A plugin that draws a dashed line across a chart.
/// @param valueOf where on the x axis; null: no line
function verticalLine(valueOf, color) {
  return {
    id: 'verticalLine',
    afterDatasetsDraw(chart) {
      if (valueOf() === null) return;
      const x = chart.scales.x.getPixelForValue(valueOf()), {top, bottom} = chart.chartArea;
      chart.ctx.save();
      chart.ctx.strokeStyle = cssColor(color);
      chart.ctx.setLineDash([4, 4]);
      chart.ctx.beginPath();
      chart.ctx.moveTo(x, top);
      chart.ctx.lineTo(x, bottom);
      chart.ctx.stroke();
      chart.ctx.restore();
    },
  };
}

/// @param onPick called with the index of the waypoint nearest to a click
function createCharts(onPick) {
  const charts = [];
  let selectedDistance = null;

  const nearestWaypoint = (distance) => waypoints.reduce((best, waypoint, i) =>
      Math.abs(waypoint.point.distance - distance) <
      Math.abs(waypoints[best].point.distance - distance) ? i : best, 0);

  const selectionLine = verticalLine(() => selectedDistance, '--quiet');

  function draw(id, curves, xTitle, yTitle, {log = false, alongPath = true} = {}) {
    const names = curves.length > 1;
    charts.push(new Chart(document.getElementById(id), {
      type: 'line',
      data: {datasets: curves},
      plugins: alongPath ? [selectionLine] : [],
      options: {
        animation: false, responsive: true, maintainAspectRatio: false, parsing: false, normalized: true,
        interaction: {mode: 'nearest', axis: 'x', intersect: false},
        elements: {point: {radius: 0, hitRadius: 8}, line: {borderWidth: 2.2}},
        scales: {x: chartAxis(xTitle, false), y: {...chartAxis(yTitle, log), beginAtZero: alongPath && !log}},
        plugins: {
          legend: {display: names, align: 'start',
                   labels: {boxWidth: 14, boxHeight: 2, color: cssColor('--ink'), sort: (a, b) => a.datasetIndex - b.datasetIndex}},
          tooltip: {callbacks: {
            title: (items) => `${xTitle.replace(/ \[.*/, '')} ${say(items[0].parsed.x, alongPath ? 'm' : '')}`,
            label: (item) => `${item.dataset.label}: ${say(item.parsed.y)}`,
          }},
        },
        onClick: (event, _, chart) => {
          if (alongPath && waypoints.length) onPick(nearestWaypoint(chart.scales.x.getValueForPixel(event.x)));
        },
      },
    }));
  }

  /// @param keys of a point's values, in their order along the path
  function curvesOf(keys, log) {
    return paths.map((path) => ({
      label: path.name, borderColor: path.color, backgroundColor: path.color,
      data: path.points.flatMap((point) => keys.map((key) => ({x: point.distance, y: point[key]})))
          .filter(({y}) => typeof y === 'number' && (!log || y > 0)),
    })).filter((curve) => curve.data.length > 0);
  }

  function drawAll(log) {
    charts.splice(0).forEach((chart) => chart.destroy());
    if (paths.length) {
      draw('trace-chart', curvesOf(['trace_before', 'trace'], log), 'distance [m]', 'trace [m²]', {log});
      draw('cost-chart', curvesOf(['cost'], false), 'distance [m]', 'cost');
    }
    const progress = data.progress.filter((step) => typeof step.cost === 'number')
        .map((step) => ({x: step.vertices, y: step.cost}));
    if (progress.length)
      draw('progress-chart', [{
        label: 'best cost', data: progress, stepped: 'before',
        borderColor: paths.length ? paths[0].color : cssColor('--accent'),
        backgroundColor: cssColor('--accent'),
      }], 'vertices', 'best cost', {alongPath: false});
    for (const [id, shown] of [['trace-box', hasBeliefs], ['cost-box', hasCost && !sweep],
                               ['progress-box', progress.length]])
      document.getElementById(id).hidden = !shown;
  }

  return {
    drawAll,
    /// Draws one of the paths above the others, which are thin.
    choose(index) {
      for (const chart of charts)
        chart.data.datasets.forEach((dataset, i) => Object.assign(dataset, i === index
            ? {borderWidth: 3.4, order: 0} : {borderWidth: 0.8, order: 1}));
      for (const chart of charts) chart.update();
    },
    select(index) {
      selectedDistance = waypoints[index].point.distance;
      for (const chart of charts) chart.draw();
    },
  };
}
