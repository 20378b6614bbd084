// Colours that colour-blind people can tell apart, the same as in the pictures of the drawings.
export const LEFT = "#1f6fd0";
export const RIGHT = "#d9581a";
export const MIDDLE = "#3c4450";
export const PLANTED = "#35a35a";
export const PREDICTED = "#9a5cc6";
export const CAPTURED = "#0a8f8f";
export const SKY = "#d9e2ec";
export const GROUND = "#eef1f5";
export const FINE_GRID = "#d3dae3";
export const GRID = "#b4bfcc";

export function sideColour(side) {
  return side > 0 ? LEFT : side < 0 ? RIGHT : MIDDLE;
}

// Each reason has a shape of its own, for the colour alone must not tell it.
export const REASONS = {
  1: { name: "better match", colour: "#1f6fd0", shape: "circle" },
  2: { name: "control change", colour: "#d9581a", shape: "up" },
  3: { name: "clip end", colour: "#3c4450", shape: "square" },
  4: { name: "forced", colour: "#9a5cc6", shape: "down" },
  5: { name: "start", colour: "#35a35a", shape: "diamond" },
  6: { name: "filter change", colour: "#0a8f8f", shape: "cross" },
};
