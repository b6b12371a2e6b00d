// Events and commands as a list. Only the rows in sight are in the page, so that its length does not matter.
import { COMMAND, ERROR, INFO, severityNames, WARNING } from '/step_store.js';
import { element, figure, setText } from '/dom.js';

const ROW_PX = 19;
const SPARE_ROWS = 4;
const filterOrder = [ERROR, WARNING, INFO, COMMAND];
const filterWords = ['Info', 'Warnings', 'Errors', 'Commands'];
const marks = ['i', '▲', '■', '▸'];

export class EventList {
  constructor(store, onChoose) {
    this.store = store;
    this.onChoose = onChoose;
    this.shown = [];       // indices into the store's events that pass the filter
    this.taken = 0;        // events of the store that the filter has seen
    // Information comes with most sequences, and would hide the rest from the list and the keys n and p.
    this.isOn = severityNames.map((name, severity) => severity !== INFO);
    this.counts = severityNames.map(() => 0);
    this.selected = -1;
    this.rows = [];
    this.list = document.getElementById('event-list');
    this.filler = element('div', { className: 'filler' });
    this.none = element('div', { className: 'none quiet', textContent: 'No events yet' });
    this.list.append(this.filler, this.none);
    this.buildFilter();
    this.list.addEventListener('scroll', () => this.draw());
    this.list.addEventListener('click', (event) => this.clicked(event));
    new ResizeObserver(() => this.draw()).observe(this.list);
  }

  buildFilter() {
    const bar = document.getElementById('event-filter');
    this.filterTexts = [];
    for (const severity of filterOrder) {
      const button = element('button', { type: 'button', className: `severity-${severity}` });
      button.dataset.testid = `filter-${severityNames[severity].toLowerCase()}`;
      button.addEventListener('click', () => this.toggle(severity, button));
      button.setAttribute('aria-pressed', this.isOn[severity]);
      this.filterTexts[severity] = button;
      bar.append(button);
    }
    this.showCounts();
  }

  toggle(severity, button) {
    this.isOn[severity] = !this.isOn[severity];
    button.setAttribute('aria-pressed', this.isOn[severity]);
    this.shown.length = 0;
    this.taken = 0;
    this.counts.fill(0);
    this.update();
    this.reveal();
  }

  reset() {
    this.shown.length = 0;
    this.taken = 0;
    this.counts.fill(0);
    this.update();
  }

  /** Takes in the events that are new. */
  update() {
    const { events } = this.store;
    for (; this.taken < events.length; ++this.taken) {
      const severity = events[this.taken].severity;
      ++this.counts[severity];
      if (this.isOn[severity]) this.shown.push(this.taken);
    }
    this.filler.style.height = `${ROW_PX * this.shown.length}px`;
    this.none.hidden = this.shown.length > 0;
    setText(this.none, this.store.events.length > 0 ? 'The filter hides all events' : 'No events yet');
    this.showCounts();
    this.draw();
  }

  showCounts() {
    filterOrder.forEach((severity) => {
      const count = this.counts[severity];
      // There is room for the counts that matter most.
      const isCounted = severity === WARNING || severity === ERROR;
      setText(this.filterTexts[severity], isCounted ? `${filterWords[severity]} ${count}` : filterWords[severity]);
      this.filterTexts[severity].title = `Show or hide (${count})`;
    });
  }

  select(k) {
    this.selected = k;
    this.reveal();
  }

  // Scrolls to the last event up to the selected step, if it is out of sight.
  reveal() {
    const index = this.countUpTo(this.selected) - 1;
    const top = Math.max(0, index) * ROW_PX;
    const { scrollTop, clientHeight } = this.list;
    if (top < scrollTop || top + ROW_PX > scrollTop + clientHeight) this.list.scrollTop = Math.max(0, top - clientHeight / 2);
    this.draw();
  }

  /** How many of the shown events lie at steps up to `k`. */
  countUpTo(k) {
    let low = 0, high = this.shown.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.store.events[this.shown[middle]].k <= k) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** The step of the next (`direction` 1) or previous (-1) event from the selected step, or -1. */
  neighbour(direction) {
    const index = direction > 0 ? this.countUpTo(this.selected) : this.countUpTo(this.selected - 1) - 1;
    return index >= 0 && index < this.shown.length ? this.store.events[this.shown[index]].k : -1;
  }

  last() {
    return this.store.events.length > 0 ? this.store.events[this.store.events.length - 1] : null;
  }

  clicked(event) {
    const row = event.target.closest('.event');
    if (row) this.onChoose(Number(row.dataset.k));
  }

  draw() {
    const first = Math.max(0, Math.floor(this.list.scrollTop / ROW_PX) - SPARE_ROWS);
    const room = Math.ceil(this.list.clientHeight / ROW_PX) + 2 * SPARE_ROWS;
    const count = Math.max(0, Math.min(room, this.shown.length - first));
    while (this.rows.length < count) this.rows.push(this.makeRow());
    this.rows.forEach((row, i) => {
      row.node.hidden = i >= count;
      if (i < count) this.fill(row, first + i);
    });
  }

  makeRow() {
    const when = element('span', { className: 'when' });
    const severity = element('span');
    const words = element('span', { className: 'words' });
    const node = element('div', { className: 'event' }, when, severity, words);
    node.setAttribute('role', 'listitem');
    node.dataset.testid = 'event';
    this.list.append(node);
    return { node, when, severity, words, place: -1 };
  }

  fill(row, place) {
    const event = this.store.events[this.shown[place]];
    row.node.style.transform = `translateY(${place * ROW_PX}px)`;
    row.node.classList.toggle('current', event.k === this.selected);
    row.node.dataset.k = event.k;
    row.severity.className = `severity severity-${event.severity}`;
    setText(row.severity, `${marks[event.severity]} ${severityNames[event.severity]}`);
    setText(row.when, `${figure(event.t_s, 1)} s`);
    setText(row.words, event.text);
    row.node.title = `Step ${this.store.ownStep(event.k)}: ${event.text}`;
  }
}
