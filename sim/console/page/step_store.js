// The numbers of all steps as one typed column a field, which grows by doubling, and the events and commands.

const FIRST_CAPACITY = 1024;

/** Severities as the server numbers those of events (hal/messages/event_id.hpp), and one for commands. */
export const INFO = 0, WARNING = 1, ERROR = 2, COMMAND = 3;
export const severityNames = ['Info', 'Warning', 'Error', 'Command'];

export class StepStore {
  constructor() {
    this.reset([]);
  }

  reset(fields) {
    this.fields = fields;
    this.capacity = FIRST_CAPACITY;
    this.columns = fields.map(() => new Float64Array(FIRST_CAPACITY).fill(NaN));
    this.indexOf = new Map(fields.map((field, index) => [field, index]));
    this.steps = 0;
    this.events = [];  // {k, t_s, severity, text}, in the order of the steps
  }

  append(answer) {
    this.reserve(answer.to);
    for (const row of answer.rows) {
      const k = row[0];
      for (let i = 0; i < this.columns.length; ++i) this.columns[i][k] = row[i] === null ? NaN : row[i];
    }
    this.steps = answer.to;
    this.appendEvents(answer);
  }

  appendEvents(answer) {
    const added = [];
    for (const [k, t_s, severity, , text] of answer.events) added.push({ k, t_s, severity, text });
    for (const [k, t_s, command, fate] of answer.commands)
      added.push({ k, t_s, severity: COMMAND, text: `${command}: ${fate}` });
    added.sort((a, b) => a.k - b.k || a.t_s - b.t_s);
    for (const event of added) this.events.push(event);
  }

  reserve(steps) {
    if (steps <= this.capacity) return;
    while (this.capacity < steps) this.capacity *= 2;
    this.columns = this.columns.map((column) => {
      const larger = new Float64Array(this.capacity).fill(NaN);
      larger.set(column);
      return larger;
    });
  }

  /** Null where the server has no such field. */
  column(field) {
    const index = this.indexOf.get(field);
    return index === undefined ? null : this.columns[index];
  }

  /** The run's own number of the step at place `k`. A console that came late or stood still has fewer places than the run steps. */
  ownStep(k) {
    const own = this.value('step', k);
    return Number.isNaN(own) ? k : own;
  }

  /** How many steps of the run, up to the newest, the console has not seen. */
  get missed() {
    return this.steps === 0 ? 0 : Math.max(0, this.ownStep(this.steps - 1) + 1 - this.steps);
  }

  /** NaN where it is not known. */
  value(field, k) {
    const index = this.indexOf.get(field);
    return index === undefined || k < 0 || k >= this.steps ? NaN : this.columns[index][k];
  }
}
