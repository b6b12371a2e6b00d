// Colours that several parts share.

// Seven equidistant stops from dark blue to pale yellow, of evenly rising lightness.
const STOPS = [[31, 46, 92], [28, 77, 124], [19, 109, 139], [44, 144, 142], [104, 178, 133], [181, 207, 124], [250, 231, 148]];
const ENTRIES = 256;

function makeTable() {
  const table = new Uint8Array(3 * ENTRIES);
  for (let i = 0; i < ENTRIES; ++i) {
    const place = (i / (ENTRIES - 1)) * (STOPS.length - 1);
    const below = Math.min(Math.floor(place), STOPS.length - 2);
    for (let c = 0; c < 3; ++c)
      table[3 * i + c] = Math.round(STOPS[below][c] + (place - below) * (STOPS[below + 1][c] - STOPS[below][c]));
  }
  return table;
}

/** 256 times red, green, blue. */
export const scaleTable = makeTable();

/** The scale as the background of an element. */
export function scaleGradient(direction) {
  return `linear-gradient(${direction}, ${STOPS.map((stop) => `rgb(${stop.join(',')})`).join(', ')})`;
}

/** A colour of the style sheet in the present theme. */
export function themeColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
}

// The 3-D view and the images are dark in both themes, so their colours do not change.
export const sceneColours = {
  truth: '#b4bcc7', network: '#ffa047', second: '#cf8ff2', pose: '#3f8ef0',
  nearer: '#ff4438', farther: '#4c8dff', agrees: '#ffffff', noSurface: '#7d8793',
};
