// The line at the top: connection, run, and what is to be known about it.
import { setText } from '/dom.js';

export class StateLine {
  constructor() {
    this.connection = document.getElementById('connection');
    this.title = document.getElementById('run-title');
    this.source = document.getElementById('run-source');
    this.notes = document.getElementById('run-notes');
    this.themeButton = document.getElementById('theme-button');
    this.run = null;
    this.failure = '';
    this.missed = 0;
  }

  showConnection(isConnected, text) {
    this.connection.dataset.state = isConnected ? 'ok' : 'alarm';
    setText(this.connection, text);
  }

  showRun(run) {
    this.run = run;
    setText(this.title, run.title);
    document.title = `${run.title} – Tumblesight console`;
    setText(this.source, run.source === 'bus' ? 'Live on the bus' : 'Recording');
    this.showNotes();
  }

  /** What the server refused last, or an empty text. */
  showFailure(text) {
    this.failure = text;
    this.showNotes();
  }

  /** How many steps of the run the console has not seen. */
  showMissed(steps) {
    if (steps === this.missed) return;
    this.missed = steps;
    this.showNotes();
  }

  showNotes() {
    const notes = [];
    if (this.run) {
      if (this.run.source === 'bus' && this.run.ended) notes.push('Run ended');
      if (this.run.whole === false) notes.push('Recording without an end: its writer was killed');
    }
    if (this.missed > 0) notes.push(`${this.missed} ${this.missed === 1 ? 'step' : 'steps'} of the run not seen`);
    if (this.failure) notes.push(this.failure);
    setText(this.notes, notes.join(' · '));
    this.notes.title = this.notes.textContent;
  }

  showTheme(theme) {
    setText(this.themeButton, theme === 'dark' ? 'Light' : 'Dark');
    this.themeButton.title = `Use ${theme === 'dark' ? 'light' : 'dark'} colours`;
  }
}
