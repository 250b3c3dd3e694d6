// Elements of the page by their names, and new ones.

export function element(id) {
  return document.getElementById(id);
}

export function made(tag, properties = {}, children = []) {
  const one = Object.assign(document.createElement(tag), properties);
  one.append(...children);
  return one;
}

export function row(cells, properties = {}) {
  return made("tr", properties, cells.map((cell) => (cell instanceof Node ? cell : made("td", { textContent: cell }))));
}

export function say(text) {
  element("status").textContent = text;
}
