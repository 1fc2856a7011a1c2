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

export const post = (path, asked = {}) =>
  answer(path, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(asked) });

export const remove = (path) =>
  answer(path, { method: "DELETE", headers: { "Content-Type": "application/json" } });

export const upload = (file) =>
  answer(`/api/jobs?name=${encodeURIComponent(file.name)}`, {
    method: "POST",
    headers: { "Content-Type": "application/octet-stream" },
    body: file,
  });

/** Calls back with each part of the state that changes, and with whether the server answers. */
export function watch({ onJob, onRun, onConnected, onLost }) {
  const source = new EventSource("/api/events");
  source.addEventListener("job", (event) => onJob(JSON.parse(event.data)));
  source.addEventListener("run", (event) => onRun(JSON.parse(event.data)));
  source.addEventListener("open", onConnected);
  source.addEventListener("error", onLost);
}
