// All charts: one window of steps, one cursor and one selected step for them together.
import { Chart } from '/chart.js';
import { element } from '/dom.js';
import { fieldName, fieldUnit } from '/field_names.js';

const LEAST_UPDATE_MS = 250;
const extraColours = ['network', 'pose', 'second', 'extra-1', 'extra-2', 'extra-3'];
const NARROWEST = 4;  // steps

function channel(field, label, colour, look = {}) {
  return { field, label, colour, ...look };
}
const dashed = { isDashed: true, isWithoutKey: true };
const thin = { isThin: true };

// The first channel is drawn first, so the truth lies below the estimates.
const standardCharts = [
  { title: 'Error', explanation: 'Error of the attitude; dashed: what the estimate expects', unit: '°', isLog: true, note: 'expected',
    channels: [channel('network_error_deg', 'network', 'network'), channel('pose_error_deg', 'pose', 'pose'),
               channel('network_expected_deg', 'network expects', 'network', dashed),
               channel('pose_expected_deg', 'pose expects', 'pose', dashed)] },
  { title: 'Rate', unit: '°/s',
    channels: [channel('true_rate_deg_s', 'truth', 'truth', thin), channel('network_rate_deg_s', 'network', 'network'),
               channel('pose_rate_deg_s', 'pose', 'pose')] },
  { title: 'Range', unit: 'm', channels: [channel('true_range_m', 'truth', 'truth', thin), channel('pose_range_m', 'pose', 'pose')] },
  { title: 'Position', unit: 'm', channels: [channel('pose_right_m', 'right', 'pose'), channel('pose_up_m', 'up', 'extra-1')] },
  { title: 'Time', unit: 'ms', channels: [channel('cycle_ms', 'cycle before', 'pose'), channel('inference_ms', 'inference', 'network')] },
];
const FIRST_COUNTER = 'frames_refused';

export class Charts {
  constructor(store, onChoose) {
    this.store = store;
    this.onChoose = onChoose;
    this.charts = [];
    this.window = null;   // [first, last] steps that the user has zoomed to, or null: all
    this.selected = -1;
    this.hovered = -1;
    this.timer = 0;
    this.lastMs = 0;
    this.list = document.getElementById('charts');
    this.menu = document.getElementById('chart-menu');
    this.addButton = document.getElementById('chart-add');
    this.allButton = document.getElementById('chart-zoom-out');
    this.allButton.addEventListener('click', () => this.setWindow(null));
    this.addButton.addEventListener('click', () => this.showMenu(this.menu.hidden));
    for (const spec of standardCharts) this.add(spec);
    this.addCounter();
  }

  add(spec) {
    const chart = new Chart(spec, this);
    this.charts.push(chart);
    this.list.append(chart.node);
    this.schedule();
    return chart;
  }

  addCounter() {
    this.counter = this.add({ title: 'Counter', unit: '', channels: [channel(FIRST_COUNTER, '', 'extra-1')] });
    this.counterMenu = element('select', { ariaLabel: 'Counter to show' });
    this.counterMenu.dataset.testid = 'counter-menu';
    this.counterMenu.addEventListener('change', () => this.setCounter(this.counterMenu.value));
    this.counter.head.querySelector('b').after(this.counterMenu);
  }

  setCounter(field) {
    this.counter.setChannels([channel(field, fieldUnit(field), 'extra-1')]);
    this.counter.showValues(this.valuesAt);
    this.schedule();
  }

  /** The fields of a run, for the menus. */
  setFields(fields) {
    this.window = null;
    this.fields = fields.filter((field) => field !== 'k' && field !== 'step');
    const kept = this.counterMenu.value || FIRST_COUNTER;
    this.counterMenu.replaceChildren(...this.fields.map((field) => element('option', { value: field, textContent: fieldName(field) })));
    this.counterMenu.value = this.fields.includes(kept) ? kept : this.fields[0];
    this.setCounter(this.counterMenu.value);
    for (const chart of this.charts) chart.drop();
    this.fillMenu();
    this.schedule();
  }

  fillMenu() {
    const list = element('div', { className: 'fields' });
    for (const field of this.fields)
      list.append(element('label', {}, element('input', { type: 'checkbox', name: 'field', value: field }), nameAndUnit(field)));
    const isLog = element('input', { type: 'checkbox', name: 'log' });
    const buttons = element('div', { className: 'toolbar' }, element('label', {}, isLog, 'Logarithmic'), element('span', { className: 'spacer' }),
      element('button', { type: 'button', textContent: 'Cancel', onclick: () => this.showMenu(false) }),
      element('button', { type: 'submit', textContent: 'Add' }));
    this.menu.replaceChildren(list, buttons);
    this.menu.onsubmit = (event) => {
      event.preventDefault();
      this.addChosen(isLog.checked);
    };
  }

  addChosen(isLog) {
    const chosen = [...this.menu.querySelectorAll('[name=field]:checked')].map((box) => box.value);
    if (chosen.length === 0) return;
    this.showMenu(false);
    this.menu.reset();
    this.addFields(chosen, isLog);
  }

  addFields(chosen, isLog) {
    const units = [...new Set(chosen.map(fieldUnit))];
    const channels = chosen.map((field, i) => channel(field, fieldName(field), extraColours[i % extraColours.length]));
    const chart = this.add({ title: '', unit: units.length === 1 ? units[0] : '', isLog, channels });
    const remove = element('button', { className: 'remove', type: 'button', textContent: '×', title: 'Remove this chart', ariaLabel: 'Remove this chart' });
    remove.addEventListener('click', () => this.remove(chart));
    chart.head.prepend(remove);
    chart.showValues(this.valuesAt);
    chart.node.scrollIntoView({ block: 'nearest' });
  }

  remove(chart) {
    chart.drop();
    chart.node.remove();
    this.charts.splice(this.charts.indexOf(chart), 1);
  }

  showMenu(isOpen) {
    this.menu.hidden = !isOpen;
    this.addButton.setAttribute('aria-expanded', isOpen);
  }

  get valuesAt() {
    return this.hovered >= 0 ? this.hovered : this.selected;
  }

  select(k) {
    this.selected = k;
    this.moveCursors();
  }
  hover(k) {
    if (k === this.hovered) return;
    this.hovered = k;
    this.moveCursors();
  }
  choose(k) {
    if (k >= 0) this.onChoose(k);
  }

  moveCursors() {
    for (const chart of this.charts) {
      chart.placeCursors();
      chart.showValues(this.valuesAt);
    }
  }

  /** A chart was zoomed or panned by the user. */
  ranged(begin, end) {
    const widened = Math.max(0, NARROWEST - (end - begin)) / 2;
    this.window = [begin - widened, end + widened];
    this.schedule();
  }

  setWindow(window) {
    this.window = window;
    if (!window) for (const chart of this.charts) chart.resetHeight();
    this.schedule();
  }

  shownWindow() {
    return this.window || [0, Math.max(1, this.store.steps - 1)];
  }

  /** At most four updates a second. */
  schedule() {
    if (this.timer !== 0) return;
    const wait = Math.max(0, this.lastMs + LEAST_UPDATE_MS - performance.now());
    this.timer = setTimeout(() => this.update(), wait);
  }

  update() {
    this.timer = 0;
    this.lastMs = performance.now();
    this.allButton.disabled = this.window === null;
    for (const chart of this.charts) chart.update(this.shownWindow());
  }

  setTheme() {
    for (const chart of this.charts) chart.drop();
    this.schedule();
  }
}

function nameAndUnit(field) {
  const unit = fieldUnit(field);
  return unit ? `${fieldName(field)} [${unit}]` : fieldName(field);
}
