// Puts the parts of the page together.
import { CommandPanel } from '/command_panel.js';
import { Charts } from '/charts.js';
import { Connection } from '/connection.js';
import { DepthView } from '/depth_view.js';
import { EventList } from '/events.js';
import { getMesh, Refusal } from '/api.js';
import { Keys } from '/keys.js';
import { Lights } from '/lights.js';
import { Numbers } from '/numbers.js';
import { Playback } from '/playback.js';
import { SceneView } from '/scene.js';
import { StateLine } from '/state_line.js';
import { StepLoader } from '/step_loader.js';
import { StepStore } from '/step_store.js';
import { Timeline } from '/timeline.js';
import { ViewControls } from '/view_controls.js';

const store = new StepStore();
const stateLine = new StateLine();
const view = makeView();
const viewControls = new ViewControls(view);
const depthView = new DepthView();
const lights = new Lights();
const numbers = new Numbers(store);
const loader = new StepLoader(showStep, (error) => stateLine.showFailure(`Step not read: ${error.message}`));
const playback = new Playback(selectionChanged, () => loader.isSettled);
const charts = new Charts(store, (k) => playback.select(k));
const events = new EventList(store, (k) => playback.select(k));
const commandPanel = new CommandPanel(document.getElementById('command-panel'));
const timeline = new Timeline(store, playback);
let isConnected = false;
let lastSelected = -1;

function makeView() {
  try {
    const id = (name) => document.getElementById(name);
    return new SceneView(id('viewport'), id('scene'), id('gizmo'));
  } catch (error) {
    // The rest of the page is of use without it.
    document.getElementById('view-note').textContent = `No 3-D view: ${error.message}`;
    return null;
  }
}

function showStep(step) {
  stateLine.showFailure('');
  if (view) view.show(step);
  viewControls.show(step);
  depthView.show(step);
  lights.show(step.detail ? step.detail.lights : []);
  numbers.show(step.k, step.detail);
}

function selectionChanged() {
  timeline.show();
  if (playback.selected < 0 || playback.selected === lastSelected) return;
  lastSelected = playback.selected;
  charts.select(lastSelected);
  events.select(lastSelected);
  loader.want(lastSelected);
}

async function readMesh(run) {
  viewControls.meshNote = '';
  if (!view) return;
  view.removeMesh();
  if (!run.target_radius_m) return;  // before a run there is no target
  view.setRadius(run.target_radius_m);
  try {
    view.setMesh(await getMesh());
  } catch (error) {
    viewControls.meshNote = error instanceof Refusal ? `No mesh: ${error.message}` : 'No mesh: the server did not answer';
  }
  view.invalidate();
}

const listener = {
  run(run, isNew) {
    stateLine.showRun(run);
    commandPanel.show(run);
    if (!isNew) {
      playback.describe(run);
      timeline.show();
      return;
    }
    lastSelected = -1;
    stateLine.showMissed(0);
    loader.reset();
    playback.begin(run);
    charts.setFields(run.fields);
    events.reset();
    timeline.schedule();
    timeline.show();
    readMesh(run);
  },
  rows() {
    stateLine.showMissed(store.missed);
    events.update();
    timeline.schedule();
    charts.schedule();
    playback.grow(store.steps);
  },
  state(connected, text) {
    const isBack = connected && !isConnected;
    isConnected = connected;
    stateLine.showConnection(connected, text);
    // What was asked for while the server was away.
    if (isBack && lastSelected >= 0 && !loader.isSettled) loader.want(lastSelected);
  },
};

new Keys({
  toggle: () => playback.toggle(),
  step: (by) => playback.select(playback.selected + by),
  first: () => playback.select(0),
  last: () => playback.select(store.steps - 1),
  faster: () => playback.changeSpeed(1),
  slower: () => playback.changeSpeed(-1),
  follow: () => playback.follow(),
  event: (direction) => {
    const k = events.neighbour(direction);
    if (k >= 0) playback.select(k);
  },
});

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  stateLine.showTheme(theme);
  if (view) view.setTheme();
  charts.setTheme();
  timeline.schedule();
}
function keepTheme(theme) {
  setTheme(theme);
  try {
    localStorage.setItem('console-theme', theme);
  } catch (error) {
    // Without storage the choice holds for this page.
  }
}
stateLine.themeButton.addEventListener('click',
  () => keepTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark'));
setTheme(document.documentElement.dataset.theme);

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', (event) => setTheme(event.matches ? 'dark' : 'light'));

/** For tests: what the page shows. `mesh`: the target's surface has arrived. */
window.console_state = () => {
  const known = (field) => {
    const value = store.value(field, playback.selected);
    return Number.isFinite(value) ? value : null;
  };
  return {
    steps: store.steps, selected: playback.selected, step: store.ownStep(playback.selected), missed: store.missed, following: playback.isFollowing, playing: playback.isPlaying,
    connected: isConnected, settled: loader.isSettled, network_error_deg: known('network_error_deg'),
    pose_error_deg: known('pose_error_deg'), mesh: view ? view.hasMesh : false, points: view ? view.cloud.count : 0, fps: view ? view.rate.perSecond : 0,
    light_texts: { ...lights.texts }, last_event: events.last() ? { ...events.last() } : null,
  };
};

new Connection(store, listener).start();
