// A scanner is a keyboard. Its keys count wherever the focus is; only Enter or Tab ends a scan, however long it takes.

// Keys with which scanners send control characters. No label has any, so the station refuses a scan with one.
const CONTROL = /^[@[\\\]^_]$/;

export function scanner({ isTyping, show, scanned }) {
  let text = "", isOver = false;
  const keep = (event) => {
    event.preventDefault();
    event.stopImmediatePropagation();
    show(text);
  };
  addEventListener("keydown", (event) => {
    if (isTyping() || event.isComposing || event.keyCode === 229) return;
    const isPlain = !event.ctrlKey && !event.altKey && !event.metaKey;
    if (event.key.length === 1 && (isPlain || event.ctrlKey && (text || CONTROL.test(event.key)))) {
      if (!event.repeat) text += isPlain ? event.key : "\ufffd";
      isOver = false;
      keep(event);
    } else if (isPlain && event.key === "Escape") {
      text = "";
      keep(event);
    } else if (isPlain && text && (event.key === "Enter" || event.key === "Tab")) {
      const whole = text;
      text = "";
      isOver = true;
      document.activeElement?.blur();
      keep(event);
      scanned(whole);
    } else if (isOver && event.key === "Enter") {
      // Some scanners end a scan with two keys. The second one must not press a button.
      keep(event);
    } else if (event.key !== "Shift") {
      isOver = false;
    }
  }, { capture: true });
}
