// The server's answers, taken apart. Every request carries the token of the page's address if it has one.

const token = new URLSearchParams(location.search).get('token');

/** An answer of the server that says why it cannot give what was asked for. */
export class Refusal extends Error {
  constructor(status, text) {
    super(text.trim());
    this.status = status;
  }
}

function addressOf(path, query) {
  const url = new URL(path, location.origin);
  for (const [name, value] of Object.entries(query)) url.searchParams.set(name, value);
  if (token !== null) url.searchParams.set('token', token);
  return url;
}

async function request(path, query = {}) {
  const answer = await fetch(addressOf(path, query), { cache: 'no-store' });
  if (!answer.ok) throw new Refusal(answer.status, await answer.text());
  return answer;
}
async function post(path, content) {
  const answer = await fetch(addressOf(path, {}), { method: 'POST', body: JSON.stringify(content) });
  if (!answer.ok) throw new Refusal(answer.status, await answer.text());
  return answer.json();
}
async function json(path, query) {
  return (await request(path, query)).json();
}
async function bytes(path, query) {
  return (await request(path, query)).arrayBuffer();
}

export function getRun() {
  return json('/api/run');
}
export function getSteps(from) {
  return json('/api/steps', { from });
}
export function getStep(k) {
  return json('/api/step', { k });
}

/** {rays, fov [rad], ranges: u16 in 1/128 m along the ray, 0: no return}. */
export async function getFrame(k) {
  const buffer = await bytes('/api/frame', { k });
  const view = new DataView(buffer);
  const rays = view.getUint16(0, true);
  if (buffer.byteLength !== 8 + 2 * rays * rays) throw new Refusal(500, 'The frame has a wrong length.');
  return { rays, fov: 1e-6 * view.getUint32(4, true), ranges: new Uint16Array(buffer, 8, rays * rays) };
}

/** {size, depths: i16 in target radii / 4096 relative to the centroid, -32768: no return}. */
export async function getDepth(k) {
  const buffer = await bytes('/api/depth', { k });
  const size = new DataView(buffer).getUint16(0, true);
  if (buffer.byteLength !== 4 + 2 * size * size) throw new Refusal(500, 'The depth image has a wrong length.');
  return { size, depths: new Int16Array(buffer, 4, size * size) };
}

/** {vertices: f32 in metres, triangles: u16}. */
export async function getMesh() {
  const buffer = await bytes('/api/mesh');
  const view = new DataView(buffer);
  const vertices = 3 * view.getUint32(0, true);
  const corners = 3 * view.getUint32(4, true);
  if (buffer.byteLength !== 8 + 4 * vertices + 2 * corners) throw new Refusal(500, 'The mesh has a wrong length.');
  return {
    vertices: new Float32Array(buffer, 8, vertices),
    triangles: new Uint16Array(buffer, 8 + 4 * vertices, corners),
  };
}

/** [{name, fields: [{name, bytes, least, most, meaning}]}] of every telecommand. */
export function getCommands() {
  return json('/api/commands');
}
/** {most_steps, faults: [{name, explanation, unit, least, most, whole}]}; least and most are 0 without a strength. */
export function getFaults() {
  return json('/api/faults');
}
/** {step} in which it takes effect, or {error} of the run. Throws a Refusal with the server's words. */
export function postCommand(command) {
  return post('/api/command', command);
}
export function postFault(fault) {
  return post('/api/fault', fault);
}

/** What `promise` gives, or null and the server's words in `notes` where it has no such thing. */
export async function orNull(promise, notes, name) {
  try {
    return await promise;
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    notes[name] = error.message;
    return null;
  }
}

/** Opens the WebSocket. `onMessage` gets each message, `onClose` is called once when it is lost or never opens. */
export function openSocket(onOpen, onMessage, onClose) {
  const url = addressOf('/ws', {});
  url.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
  const socket = new WebSocket(url);
  socket.onopen = onOpen;
  socket.onmessage = (event) => onMessage(JSON.parse(event.data));
  socket.onclose = onClose;
  return socket;
}
