// Small helpers for the elements of the page.

export function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

/** Writes only what has changed, which saves the browser a layout. */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Of the buttons of a group, shows the one whose data-`name` is `value` as pressed. */
export function press(group, name, value) {
  for (const button of group.querySelectorAll('button')) button.setAttribute('aria-pressed', button.dataset[name] === value);
}

/** A number with a fixed number of digits, or a dash where it is not known. */
export function figure(number, digits) {
  return number === null || number === undefined || !Number.isFinite(number) ? '–' : number.toFixed(digits).replace('-', '−');
}
