// What the page asks of the server.

export class Refused extends Error {}

async function answer(path, options = {}) {
  const response = await fetch(path, options);
  const isJson = (response.headers.get("content-type") || "").startsWith("application/json");
  const body = isJson ? await response.json() : await response.text();
  if (!response.ok) throw new Refused(isJson ? body.error : body);
  return body;
}

export const get = (path) => answer(path);

/** What comes of it is told by `watch`: the answer may be overtaken by that. */
export const post = (path, asked = {}) =>
  answer(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(asked) });

export const remove = (path) =>
  answer(path, { method: "DELETE", headers: { "Content-Type": "application/json" } });

/** more: further words of the address. */
export const upload = (file, path = "/api/jobs", more = {}) =>
  answer(`${path}?${new URLSearchParams({ name: file.name, ...more })}`, {
    method: "POST",
    headers: { "Content-Type": "application/octet-stream" },
    body: file,
  });

/** Calls back with each part of the state that changes, by its name, and with whether the server answers. */
export function watch(parts, { onConnected, onLost }) {
  const source = new EventSource("/api/events");
  for (const [name, changed] of Object.entries(parts)) {
    source.addEventListener(name, (event) => changed(JSON.parse(event.data)));
  }
  source.addEventListener("open", onConnected);
  source.addEventListener("error", onLost);
}
