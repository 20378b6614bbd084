// Why a transition was made: from, to, reason, and the cost by channel as bars.
import { element } from "./elements.js";
import { REASONS } from "./palette.js";

// Shows a transition of the history in a box; nothing where there is none.
export function showDetails(box, found) {
  if (box.shown === found) return;
  box.shown = found;
  if (!found) {
    box.replaceChildren(element("p", { className: "hint" }, "No transition yet: press a key."));
    return;
  }
  const { transition: t, time } = found;
  const stay = t.stayCost ? `, ${t.stayCost.toFixed(2)} to stay` : "";
  box.replaceChildren(
    element(
      "p",
      {},
      element("b", {}, REASONS[t.reason].name),
      ` at ${time.toFixed(2)} s · cost ${t.cost.toFixed(2)}${stay}`,
    ),
    element("p", { className: "moments" }, t.from?.clip ? `${moment(t.from)} → ${moment(t.to)}` : moment(t.to)),
    bars(t.channels),
    others("next best", t.runnersUp, (match) => `${moment(match)}, ${match.cost.toFixed(2)}`),
    others("better, but", t.excluded, ({ match, reason }) => `${moment(match)}: ${reason}`),
  );
}

function moment({ clip, timeS }) {
  return `${clip} ${timeS.toFixed(2)} s`;
}

function bars(channels) {
  const most = Math.max(...channels.map(({ cost }) => cost), 1e-6);
  const rows = channels.flatMap(({ channel, cost }) => [
    element("span", {}, channel),
    element("i", {}, element("b", { style: `width: ${(100 * cost) / most}%` })),
    element("span", {}, cost.toFixed(2)),
  ]);
  return element("div", { className: "bars" }, ...rows);
}

function others(label, list, tell) {
  if (!list.length) return "";
  return element("p", { className: "others" }, `${label}: ${list.slice(0, 2).map(tell).join(" · ")}`);
}
