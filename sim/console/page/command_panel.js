// Telecommands and faults of the sensor, sent into the run that is shown. The simulator numbers and signs them.
import { getCommands, getFaults, postCommand, postFault, Refusal } from '/api.js';
import { element } from '/dom.js';

/** What a list shows for the faults that have more than a name. */
const FAULT_LABELS = {
  drop: 'Drop frames',
  freeze: 'Freeze the sensor',
  delay: 'Delay frames by a step',
  occlude: 'Occlude the target',
  turn: 'Turn the chaser',
};
const UNCHECKED = 'Bytes, unchecked';
const MOST_FUNCTION = 127;

/** An element that tests find by this name. */
function tested(name, tag, properties, ...children) {
  const made = element(tag, properties, ...children);
  made.dataset.testid = name;
  return made;
}

export class CommandPanel {
  constructor(panel) {
    this.panel = panel;
    this.answer = tested('command-answer', 'p', { id: 'command-answer', role: 'status' });
    this.name = tested('command-name', 'select', { ariaLabel: 'Telecommand' });
    this.fields = element('span', { className: 'fields' });
    this.name.addEventListener('change', () => this.showFields());
    this.faultName = tested('fault-kind', 'select', { ariaLabel: 'Fault' });
    this.strength = tested('fault-strength', 'input', { type: 'number', step: 'any', ariaLabel: 'Strength', required: true });
    this.unit = element('span', {});
    this.steps = tested('fault-steps', 'input', { type: 'number', min: 1, value: 5, ariaLabel: 'Steps', required: true });
    this.faultName.addEventListener('change', () => this.showStrength());
    this.forms = [this.commandForm(), this.faultForm()];
    for (const form of this.forms) form.hidden = true;
    this.panel.append(...this.forms, this.answer);
    this.panel.hidden = true;
    this.isFilled = false;
    this.commands = [];
    this.faults = [];
  }

  /** A recording takes none. */
  async show(run) {
    this.panel.hidden = run.source !== 'bus';
    if (this.panel.hidden || this.isFilled) return;
    this.isFilled = true;
    try {
      const [commands, faults] = await Promise.all([getCommands(), getFaults()]);
      this.fillCommands(commands);
      this.fillFaults(faults);
      for (const form of this.forms) form.hidden = false;
      this.say('');
    } catch (error) {
      this.isFilled = false;  // the next call tries again
      this.say(`No telecommands and faults: ${wordsOf(error)}`, true);
    }
  }

  fillCommands(commands) {
    this.commands = commands;
    this.name.replaceChildren(...[...commands.map((command) => command.name), UNCHECKED].map((name) => element('option', {}, name)));
    this.showFields();
  }

  fillFaults({ most_steps: mostSteps, faults }) {
    this.faults = faults;
    this.steps.max = mostSteps;
    const labelled = faults.filter((fault) => FAULT_LABELS[fault.name]);
    const effects = faults.filter((fault) => !FAULT_LABELS[fault.name]);
    const option = (fault) => element('option', { value: fault.name, title: fault.explanation }, FAULT_LABELS[fault.name] ?? fault.name);
    this.faultName.replaceChildren(...labelled.map(option),
      element('optgroup', { label: 'Effects of sensor and scene' }, ...effects.map(option)));
    this.showStrength();
  }

  commandForm() {
    const form = tested('command-form', 'form', { className: 'toolbar' });
    form.append(this.name, this.fields, tested('command-send', 'button', { type: 'submit' }, 'Send'));
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.sendCommand();
    });
    return form;
  }

  sendCommand() {
    const values = Object.fromEntries([...this.fields.children].map((field) => [field.name, field.value.trim()]));
    if (this.name.value !== UNCHECKED) {
      this.tell(this.name.value, () => postCommand({ name: this.name.value, arguments: values }));
    } else if (isFunctionCode(values.function)) {
      this.tell(UNCHECKED, () => postCommand({ function: Number(values.function), bytes: values.bytes }));
    } else {
      this.say(`${UNCHECKED}: function '${values.function}' must be a whole number from 0 to ${MOST_FUNCTION}`, true);
    }
  }

  faultForm() {
    const form = tested('fault-form', 'form', { className: 'toolbar' });
    form.append(this.faultName, this.strength, this.unit, element('label', {}, 'for', this.steps, 'steps'),
      tested('fault-begin', 'button', { type: 'submit' }, 'Begin'));
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      const wanted = { fault: this.faultName.value, steps: Number(this.steps.value) };
      if (!this.strength.hidden) wanted.strength = Number(this.strength.value);
      this.tell(this.faultName.selectedOptions[0].textContent, () => postFault(wanted));
    });
    return form;
  }

  showStrength() {
    const { explanation, unit, least, most } = this.faults.find((fault) => fault.name === this.faultName.value);
    const isNeeded = least !== 0 || most !== 0;
    this.faultName.title = explanation;
    this.strength.hidden = !isNeeded;
    this.strength.required = isNeeded;
    this.strength.placeholder = `${least}–${most}`.replaceAll('-', '−');
    this.strength.title = `${least} to ${most} ${unit}: ${explanation}`;
    this.strength.value = '';
    this.unit.textContent = isNeeded ? unit : '';
  }

  showFields() {
    const command = this.commands.find((candidate) => candidate.name === this.name.value);
    const fields = command ? command.fields : [
      { name: 'function', meaning: `function code, 0 to ${MOST_FUNCTION}` },
      { name: 'bytes', meaning: 'arguments in hexadecimal digits' },
    ];
    this.fields.replaceChildren(...fields.map((field) => element('input', {
      name: field.name, placeholder: field.name, title: `${field.name}: ${field.meaning}`, ariaLabel: field.name,
      size: 8, autocomplete: 'off',
    })));
  }

  async tell(what, send) {
    this.say(`${what}: sent, waiting for the run`);
    try {
      const { step, error } = await send();
      if (error) this.say(`${what}: ${error}`, true);
      else this.say(`${what}: in step ${step} of the run`);
    } catch (error) {
      this.say(error instanceof Refusal ? error.message : `${what}: ${wordsOf(error)}`, true);
    }
  }

  say(text, isRefused = false) {
    this.answer.className = isRefused ? 'refused' : '';
    this.answer.textContent = text;
  }
}

function wordsOf(error) {
  return error instanceof Refusal ? error.message : 'the server did not answer';
}

/** An empty field is not function 0. */
function isFunctionCode(text) {
  return /^\d+$/.test(text) && Number(text) <= MOST_FUNCTION;
}
