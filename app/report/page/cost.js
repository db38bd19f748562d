// What the cost of a plan consists of, and how alpha would change it.
'use strict';

/// Length and accumulated uncertainty of the planned path and of its baseline, as the cost has them:
/// J = alpha * length + (1 - alpha) * kappa * uncertainty.
function costParts({baseline, ...planned}) {
  return [planned, baseline].filter((path) => path?.cost > 0).map((path) => (
      {length: path.metric_length, uncertainty: path.metric_length * path.mean_trace}));
}

function costAt(alpha, kappa, {length, uncertainty}) {
  const ofLength = alpha * length, ofUncertainty = (1 - alpha) * kappa * uncertainty;
  return {ofLength, ofUncertainty, sum: ofLength + ofUncertainty};
}

/// The alpha at which two paths cost the same; null: one of them is cheaper at every alpha.
function equalAlpha(kappa, [a, b]) {
  const longer = a.length - b.length, moreCertain = kappa * (b.uncertainty - a.uncertainty);
  const alpha = moreCertain / (moreCertain + longer);
  return longer * moreCertain > 0 ? alpha : null;
}

function costAdvice(kappa, parts) {
  const advice = 'A larger alpha asks for a shorter path, a smaller alpha or a larger kappa for a more certain one.';
  if (parts.length < 2) return advice;
  const equal = equalAlpha(kappa, parts), [first, second] = paths.map(({name}) => name);
  const isLonger = parts[0].length > parts[1].length;
  const isFirstCheaper = costAt(0.5, kappa, parts[0]).sum < costAt(0.5, kappa, parts[1]).sum;
  return `${advice} ` + (equal === null ? `${isFirstCheaper ? first : second} is cheaper at every alpha.`
      : `These two paths cost the same at alpha ${say(equal)}: ${isLonger ? first : second} is cheaper below it, ` +
        `${isLonger ? second : first} above it.`);
}

function fillCost() {
  const {alpha, kappa, command} = data.result, parts = costParts(data.result);
  element('cost').hidden = !(command === 'plan' && parts.length && kappa > 0);
  if (element('cost').hidden) return;
  const slider = element('cost-alpha');
  const show = () => {
    const at = Number(slider.value);
    element('cost-alpha-value').textContent = `${at}${at === alpha ? ', as planned' : ''}`;
    element('cost-rows').replaceChildren(...parts.map((part, i) => {
      const {ofLength, ofUncertainty, sum} = costAt(at, kappa, part);
      const share = make('meter', undefined, {min: 0, max: 1, value: ofLength / sum});
      const row = make('tr'), bar = make('td');
      bar.append(share);
      row.append(make('td', paths[i].name), make('td', say(sum)), make('td', say(100 * ofLength / sum, '%')), bar,
                 make('td', say(100 * ofUncertainty / sum, '%')));
      return row;
    }));
  };
  slider.value = alpha;
  slider.addEventListener('input', show);
  element('cost-advice').textContent = costAdvice(kappa, parts) + ` Kappa is ${say(kappa, '1/m²')}` +
      `${data.result.kappa_is_automatic ? ', chosen automatically' : ''}.`;
  show();
}
