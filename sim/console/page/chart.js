// One chart: a headline with the values at the cursor, and the curves, drawn by dygraphs. The cursors are
// elements over the canvas, so that moving them draws nothing anew.
import { element, figure, setText } from '/dom.js';
import { themeColour } from '/colours.js';
import { fieldDigits } from '/field_names.js';
import { ThinnedRows } from '/thinned_rows.js';

export class Chart {
  /** `spec`: {title, unit, isLog, channels: [{field, label, colour, isDashed, isThin}]}; `group`: the charts it belongs to. */
  constructor(spec, group) {
    this.spec = spec;
    this.group = group;
    this.thinned = new ThinnedRows();
    this.graph = null;
    this.buildElements();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.plot);
  }

  buildElements() {
    const title = element('b', { textContent: this.spec.title, title: this.spec.explanation || '' });
    this.head = element('div', { className: 'chart-head' }, title);
    if (this.spec.unit) this.head.append(element('span', { className: 'quiet', textContent: this.spec.unit }));
    this.surface = element('div', { className: 'surface' });
    this.selectedLine = element('div', { className: 'cursor selected', hidden: true });
    this.hoverLine = element('div', { className: 'cursor hover', hidden: true });
    this.plot = element('div', { className: 'plot' }, this.surface, this.selectedLine, this.hoverLine);
    this.node = element('div', { className: 'chart' }, this.head, this.plot);
    this.node.dataset.testid = 'chart';
    this.buildKeys();
    if (this.spec.note) this.head.append(element('span', { className: 'key quiet' }, element('i', { className: 'dashed' }), this.spec.note));
  }

  buildKeys() {
    for (const key of this.keys || []) key.node.remove();
    this.keys = this.spec.channels.filter((channel) => !channel.isWithoutKey).map((channel) => {
      const mark = element('i', { className: channel.isDashed ? 'dashed' : '' });
      mark.style.borderTopColor = `var(--${channel.colour})`;
      const text = element('span', { textContent: channel.label });
      const node = element('span', { className: 'key', title: channel.label }, mark, text);
      this.head.append(node);
      return { node, text, channel };
    });
  }

  setChannels(channels) {
    this.spec.channels = channels;
    this.buildKeys();
    this.drop();
  }

  listen() {
    this.plot.addEventListener('mousemove', (event) => this.group.hover(this.stepAt(event)));
    this.plot.addEventListener('mouseleave', () => this.group.hover(-1));
  }

  stepAt(event) {
    if (!this.graph) return -1;
    const x = event.clientX - this.plot.getBoundingClientRect().left;
    return Math.max(0, Math.min(this.group.store.steps - 1, Math.round(this.graph.toDataXCoord(x))));
  }

  /** Without a graph the next update makes one. */
  drop() {
    if (this.graph) this.graph.destroy();
    this.graph = null;
    this.thinned.clear();
  }

  update(window) {
    const { store } = this.group;
    if (store.steps === 0 || this.plot.clientHeight < 20) return;
    const rows = this.rows(window);
    this.window = window;
    if (!this.graph) this.makeGraph(rows, window);
    else this.graph.updateOptions({ file: rows, dateWindow: window });
    this.placeCursors();
  }

  // One window's width more on each side, so that panning finds curves there.
  rows([begin, end]) {
    const { store } = this.group;
    const span = Math.max(1, end - begin);
    const from = Math.max(0, Math.floor(begin - span));
    const to = Math.min(store.steps, Math.ceil(end + span) + 1);
    const columns = this.spec.channels.map((channel) => store.column(channel.field)).map((column) => column || []);
    return this.thinned.cover(columns, from, to, span, this.spec.isLog);
  }

  makeGraph(rows, window) {
    const { channels, isLog } = this.spec;
    const series = {};
    const labels = ['step'];
    for (const channel of channels) {
      labels.push(channel.label);
      series[channel.label] = {
        color: themeColour(channel.colour), strokeWidth: channel.isThin || channel.isDashed ? 1 : 1.5,
        strokePattern: channel.isDashed ? [4, 3] : null,
      };
    }
    this.graph = new Dygraph(this.surface, rows, {
      labels, series, logscale: Boolean(isLog), dateWindow: window, legend: 'never', highlightCircleSize: 0, showLabelsOnHighlight: false,
      animatedZooms: false, rightGap: 4, pointSize: 1.2, gridLineColor: themeColour('grid'), axisLineColor: themeColour('line'),
      axes: { y: { axisLabelWidth: 36, pixelsPerLabel: 15, axisLabelFormatter: shortNumber, ...(isLog ? { ticker: decades } : {}) },
              x: { axisLabelWidth: 44, pixelsPerLabel: 50, axisLabelFormatter: (place) => this.stepLabel(place) } },
      xAxisHeight: 14, axisLabelFontSize: 10, axisTickSize: 2,
      interactionModel: this.interaction(),
      clickCallback: (event) => this.group.choose(this.stepAt(event)),
      drawCallback: (graph, isInitial) => this.drawn(graph, isInitial),
    });
  }

  stepLabel(place) {
    return Number.isInteger(place) ? String(this.group.store.ownStep(place)) : '';
  }

  interaction() {
    return Object.assign({}, Dygraph.defaultInteractionModel, { dblclick: () => this.group.setWindow(null) });
  }

  drawn(graph, isInitial) {
    // Only the user can have changed it from what was last set.
    const [begin, end] = graph.xAxisRange();
    const isSame = Math.abs(begin - this.window[0]) < 1e-6 && Math.abs(end - this.window[1]) < 1e-6;
    if (!isInitial && !isSame) this.group.ranged(begin, end);
    this.placeCursors();
  }

  resetHeight() {
    if (this.graph) this.graph.updateOptions({ valueRange: null }, true);
  }

  resize() {
    if (this.graph) this.graph.resize();
    else this.group.schedule();
    this.placeCursors();
  }

  placeCursors() {
    this.placeCursor(this.selectedLine, this.group.selected);
    this.placeCursor(this.hoverLine, this.group.hovered);
  }

  placeCursor(line, k) {
    // The graph is not yet assigned while it draws for the first time.
    if (!this.graph) return;
    const area = this.graph.getArea();
    const x = k < 0 ? -1 : this.graph.toDomXCoord(k);
    line.hidden = !(x >= area.x - 0.5 && x <= area.x + area.w + 0.5);
    if (line.hidden) return;
    line.style.transform = `translateX(${Math.round(x)}px)`;
    line.style.top = `${area.y}px`;
    line.style.height = `${area.h}px`;
  }

  showValues(k) {
    for (const { text, channel } of this.keys) {
      const value = this.group.store.value(channel.field, k);
      setText(text, `${channel.label} ${figure(value, fieldDigits(channel.field))}`);
    }
  }
}

// Ticks at the powers of ten, or at 1, 2 and 5 times these where the axis is short.
function decades(least, greatest) {
  const isShort = greatest / least < 30;
  const ticks = [];
  for (let power = Math.floor(Math.log10(least)); power <= Math.ceil(Math.log10(greatest)); ++power)
    for (const digit of isShort ? [1, 2, 5] : [1]) {
      const v = digit * Math.pow(10, power);
      if (v >= least && v <= greatest) ticks.push({ v, label: shortNumber(v) });
    }
  return ticks;
}
function shortNumber(value) {
  const size = Math.abs(value);
  if (size >= 1e5) return value.toExponential(0).replace('e+', 'e');
  return String(parseFloat(value.toPrecision(size >= 1000 ? 5 : 4))).replace('-', '−');
}
