// Telecommands and faults of the sensor, sent into the run that is shown. The simulator numbers and signs them.
import { getCommands, postCommand, postFault, Refusal } from '/api.js';
import { element } from '/dom.js';

const FAULTS = [
  ['drop', 'Drop frames'],
  ['freeze', 'Freeze the sensor'],
  ['delay', 'Delay frames by a step'],
];
const UNCHECKED = 'Bytes, unchecked';

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
    this.panel.append(this.commandForm(), this.faultForm(), this.answer);
    this.panel.hidden = true;
    this.isFilled = false;
    this.commands = [];
  }

  /** A recording takes none. */
  async show(run) {
    this.panel.hidden = run.source !== 'bus';
    if (this.panel.hidden || this.isFilled) return;
    this.isFilled = true;
    this.commands = await getCommands();
    for (const command of this.commands) this.name.append(element('option', {}, command.name));
    this.name.append(element('option', {}, UNCHECKED));
    this.showFields();
  }

  commandForm() {
    const form = tested('command-form', 'form', { className: 'toolbar' });
    form.append(this.name, this.fields, tested('command-send', 'button', { type: 'submit' }, 'Send'));
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.tell(this.name.value, () => postCommand(this.command()));
    });
    return form;
  }

  faultForm() {
    const form = tested('fault-form', 'form', { className: 'toolbar' });
    const kind = tested('fault-kind', 'select', { ariaLabel: 'Fault of the sensor' });
    for (const [value, text] of FAULTS) kind.append(element('option', { value }, text));
    const steps = tested('fault-steps', 'input', { type: 'number', min: 1, max: 1000, value: 5, ariaLabel: 'Steps' });
    form.append(kind, element('label', {}, 'for', steps, 'steps'), tested('fault-begin', 'button', { type: 'submit' }, 'Begin'));
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.tell(kind.selectedOptions[0].textContent, () => postFault({ fault: kind.value, steps: Number(steps.value) }));
    });
    return form;
  }

  showFields() {
    const command = this.commands.find((candidate) => candidate.name === this.name.value);
    const fields = command ? command.fields : [
      { name: 'function', meaning: 'function code, 0 to 127' },
      { name: 'bytes', meaning: 'arguments in hexadecimal digits' },
    ];
    this.fields.replaceChildren(...fields.map((field) => element('input', {
      name: field.name, placeholder: field.name, title: `${field.name}: ${field.meaning}`, ariaLabel: field.name,
      size: 8, autocomplete: 'off',
    })));
  }

  command() {
    const values = Object.fromEntries([...this.fields.children].map((field) => [field.name, field.value.trim()]));
    if (this.name.value === UNCHECKED) return { function: Number(values.function), bytes: values.bytes };
    return { name: this.name.value, arguments: values };
  }

  async tell(what, send) {
    this.answer.className = '';
    this.answer.textContent = `${what}: sent, waiting for the run`;
    try {
      const answer = await send();
      this.answer.className = answer.error ? 'refused' : '';
      this.answer.textContent = answer.error ? `${what}: ${answer.error}` : `${what}: in step ${answer.step} of the run`;
    } catch (error) {
      this.answer.className = 'refused';
      this.answer.textContent = error instanceof Refusal ? error.message : `${what}: the server did not answer`;
    }
  }
}
