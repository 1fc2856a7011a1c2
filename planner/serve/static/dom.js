// Small things that all pages of the house need.

export const $ = (id) => document.getElementById(id);

export function element(name, text = "", more = {}) {
  return Object.assign(document.createElement(name), { textContent: text, ...more });
}

export const item = (text) => element("li", text);

/** Says something where it is not said already, so that screen readers are not told twice. */
export function say(place, text, kind = "") {
  if (place.textContent !== text) place.textContent = text;
  if (place.className !== kind) place.className = kind;
}

/** Does something, and says what was wrong with it if it is refused. */
export async function tried(place, work) {
  try {
    await work();
  } catch (error) {
    say(place, error.message, "bad");
  }
}

/** Puts a button behind a text that copies it, also where a page may not write to the clipboard by itself. */
export function copyable(text) {
  const button = element("button", "Copy", { type: "button", className: "copy" });
  const says = element("span", "", { className: "quiet copied" });
  says.setAttribute("role", "status");
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(text.textContent);
    } catch {
      getSelection().selectAllChildren(text);
      document.execCommand("copy");
    }
    says.textContent = "copied";
    setTimeout(() => (says.textContent = ""), 3000);
  });
  text.after(button, says);
}

/** Offers names to choose from, and keeps what was chosen where that is still there. */
export function offer(select, names) {
  const chosen = select.value;
  select.replaceChildren(...names.map((name) => element("option", name)));
  if (names.includes(chosen)) select.value = chosen;
}

/** To paint on a canvas that bitmaps are put on, or that is one: all in memory, with no way to a graphics card between. */
export const brushOf = (canvas) => canvas.getContext("2d", { willReadFrequently: true });
