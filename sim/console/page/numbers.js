// The numbers of the selected step: truth, network and pose beside each other.
import { element, figure, setText } from '/dom.js';

const rows = [
  ['attitude-error', 'Attitude error', '°'], ['expected-error', 'Expected error', '°'],
  ['range', 'Range', 'm'], ['right', 'Right', 'm'], ['up', 'Up', 'm'], ['rate', 'Rate', '°/s'],
];
const wideRows = [
  ['sigma-attitude', 'Sigma, attitude'], ['sigma-position', 'Sigma, position'], ['second', '2nd hypothesis'], ['doubts', 'Doubts'],
];

export class Numbers {
  constructor(store) {
    this.store = store;
    this.cells = {};
    const table = document.getElementById('numbers');
    table.append(columns(), heading(), this.body());
    this.show(-1, null);
  }

  body() {
    const body = element('tbody');
    for (const [key, name, unit] of rows) {
      const row = element('tr', {}, element('th', { scope: 'row', textContent: name }));
      this.cells[key] = [0, 1, 2].map(() => row.appendChild(element('td')));
      this.cells[key][2].dataset.testid = `pose-${key}`;
      this.cells[key][1].dataset.testid = `network-${key}`;
      row.append(element('td', { className: 'unit', textContent: unit }));
      body.append(row);
    }
    for (const [key, name] of wideRows) {
      const cell = element('td', { colSpan: 4, className: 'wide' });
      cell.dataset.testid = key;
      this.cells[key] = cell;
      body.append(element('tr', {}, element('th', { scope: 'row', textContent: name }), cell));
    }
    return body;
  }

  row(key, truth, network, pose, digits) {
    [truth, network, pose].forEach((number, i) => setText(this.cells[key][i], figure(number, digits)));
  }
  wide(key, text) {
    setText(this.cells[key], text);
    this.cells[key].title = text;
  }

  show(k, detail) {
    const value = (field) => this.store.value(field, k);
    this.row('attitude-error', null, value('network_error_deg'), value('pose_error_deg'), 3);
    this.row('expected-error', null, value('network_expected_deg'), value('pose_expected_deg'), 3);
    this.row('range', value('true_range_m'), null, value('pose_range_m'), 3);
    this.row('right', null, null, value('pose_right_m'), 4);
    this.row('up', null, null, value('pose_up_m'), 4);
    this.row('rate', value('true_rate_deg_s'), value('network_rate_deg_s'), value('pose_rate_deg_s'), 3);
    const pose = detail ? detail.pose : null;
    this.wide('sigma-attitude', pose ? `${threeOf(pose.sigma_deg, 1, 3)} °` : '–');
    this.wide('sigma-position', pose ? `${threeOf(pose.sigma_m, 1000, 1)} mm` : '–');
    const second = detail ? detail.second : null;
    this.wide('second', second ? `odds ${figure(second.odds, 2)} to 1` : '–');
    this.wide('doubts', doubtsOf(detail));
  }
}

function threeOf(numbers, factor, digits) {
  return numbers.map((number) => figure(factor * number, digits)).join(', ');
}

function doubtsOf(detail) {
  if (!detail || !(detail.pose || detail.network)) return '–';
  const doubts = [];
  if (detail.network) for (const doubt of detail.network.doubts || []) doubts.push(`network: ${doubt}`);
  if (detail.pose) for (const doubt of detail.pose.doubts) doubts.push(`pose: ${doubt}`);
  return doubts.join('; ') || 'none';
}

function columns() {
  const group = element('colgroup', {}, element('col', { className: 'name' }));
  for (let i = 0; i < 3; ++i) group.append(element('col'));
  group.append(element('col', { className: 'unit' }));
  return group;
}
function heading() {
  const row = element('tr', {}, element('th'));
  for (const name of ['Truth', 'Network', 'Pose', '']) row.append(element('th', { scope: 'col', textContent: name }));
  return element('thead', {}, row);
}
