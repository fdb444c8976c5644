// Made by tools/page_types.py from docs/page.schema.json: change that, not this.

/** What people wrote, as plain text, never markup. */
export type Words = {
  title: string;
  artist: string;
  badge: string;
  difficulty: string;
  steps: string;
  bpm: string;
  credit: string;
  file: string;
  music: string;
  preset: string;
  index: string;
  meter: string;
};

/** The panels under all dancers. */
export type Pad = {
  /** Of the panels, by column. */
  names: string[];
  /** Their middles, in panel widths. */
  panels: [number, number][];
  /** Which way each arrow points. */
  arrows: [number, number][];
  centre: [number, number];
  /** Degrees of each arrow; null: a square. */
  directions: (number | null)[];
  /** Metres of a panel. */
  width: number;
};

/** Colours and times of the films' notes. */
export type Style = {
  hold: string;
  roll: string;
  mine: string;
  fake: string;
  receptor: string;
  background: string;
  lane_line: string;
  accent: string;
  players: [string, string];
  quantisation: string[];
  /** By the name of a difficulty. */
  difficulty: Record<string, string>;
  /** By severity, and of moves. */
  callout: Record<string, string>;
  /** What a move is called beside the notes. */
  callouts: Record<string, string>;
  limbs: [string, string, string, string];
  limbs_rgb: [[number, number, number], [number, number, number], [number, number, number], [number, number, number]];
  /** The foot's marker on an arrow's tail, in sizes of an arrow. */
  mark: {
    aside: [number, number];
    size: number;
  };
  /** Seconds of a receptor's light. */
  flash: number;
  /** Seconds of a panel's light. */
  panel: number;
};

/** One of the films' cameras. */
export type Camera = {
  azimuth: number;
  elevation: number;
  field: number;
  height: number;
  margin: number;
  arms: number;
  feet_only: boolean;
  region: [number, number, number, number];
};

/** The films' cameras, light and colours (configs). */
export type Look = {
  /** By name. */
  cameras: Record<string, Camera>;
  free_field: number;
  /** How a camera follows her. */
  follow: {
    seconds: number;
    along: number;
    region: [number, number, number, number];
    back: number;
  };
  /** Where it comes from, and its shadow. */
  light: {
    azimuth: number;
    elevation: number;
    shadow: number;
    shadow_soft: number;
    shadow_far: number;
    contact: number;
    contact_soft: number;
    contact_height: number;
  };
  /** Shades of the dancer. */
  toon: {
    bands: [number, number];
    soft: number;
    levels: [number, number, number];
    shade: [number, number, number];
    limbs: number;
    rim: number;
    rim_from: number;
    outline: [number, number, number];
    outline_width: number;
  };
  /** Colours and sizes of the stage. */
  stage: {
    floor: [number, number, number];
    floor_far: [number, number, number];
    floor_line: [number, number, number];
    wall: [number, number, number];
    wall_top: [number, number, number];
    strip: [number, number, number];
    pad: [number, number, number];
    pad_side: [number, number, number];
    panel: [number, number, number];
    panel_blank: [number, number, number];
    groove: [number, number, number];
    arrow: [number, number, number];
    tile: number;
    pool: number;
    radius: number;
    pad_height: number;
    mark: number;
    glow: number;
  };
};

/** The stage's faces, and the box that is always in the picture. */
export type Stage = {
  corners: [[number, number, number], [number, number, number], [number, number, number], [number, number, number]][];
  uv: [[number, number], [number, number], [number, number], [number, number]][];
  kinds: number[];
  low: [number, number, number];
  high: [number, number, number];
  corner: [number, number];
  panel: number[][];
  arrow: [number, number][][];
  tall: number;
  sole: number;
  /** Metres from her over which her shadow grows light. */
  shadow_fade: [number, number];
  /** Of its ring that a foot keeps beside the panel that it presses. */
  ring_share: number;
};

/** A run of triangles of one material. */
export type Part = {
  first: number;
  count: number;
  feet: boolean;
  /** 0 left, 1 right, 2 no foot. */
  side: 0 | 1 | 2;
  limb: boolean;
  /** The texture, of the dancer and of a second one. */
  skin: number[];
  tint: [number, number, number][];
};

/** A line on the ground: two joints and places beside them. */
export type FootMark = {
  joints: [number, number];
  at: [[number, number, number], [number, number, number]];
};

/** The dancer's mesh and joints. */
export type Body = {
  low: [number, number, number];
  size: [number, number, number];
  uv: [[number, number], [number, number]];
  vertices: number;
  /** Metres that 255 of mesh.above stands for. */
  above: number;
  skins: number;
  parts: Part[];
  names: string[];
  parents: number[];
  offsets: [number, number, number][];
  inverseBind: number[][];
  marks: [FootMark | null, FootMark | null, FootMark | null, FootMark | null];
};

/** Joints with keys on one even clock; numbers are the array NAME.turnNUMBER. */
export type MotionGroup = {
  number: number;
  joints: number[];
  /** Keys a second. */
  rate: number;
  /** Number of the first key, counted from second 0. */
  first: number;
  /** Of each joint's numbers. */
  steps: number[];
  /** Of each joint: whether w is there; else it follows from x, y and z. */
  full: boolean[];
};

/** What one dancer does. */
export type MotionDoc = {
  name: string;
  groups: MotionGroup[];
  start: number;
  end: number;
};

/** The second dancer, if there is one. */
export type SecondDancer = {
  name: string;
  /** Rows that she steps with other limbs. */
  rows: number[];
};

/** What the linter found. */
export type Finding = {
  rule: string;
  name: string;
  severity: "error" | "warning" | "info";
  message: string;
  beat: number | null;
  second: number | null;
  column: number | null;
};

/** One of the hardest parts. */
export type Passage = {
  /** First measure. */
  from: number;
  /** Where it ends, in measures. */
  to: number;
  start: number;
  end: number;
  /** Steps a second. */
  rate: number;
  plain: boolean;
  /** What the feet do, each with its count (`turn`: degrees). */
  tags: [string, number][];
  /** Whose it is where there are two, from 1; else 0. */
  player: number;
  /** Its place among the hardest. */
  number: number;
  /** Measures of passages with the same tags. */
  again: [number, number][];
};

/** What exchanging a row's feet would change. */
export type Flip = {
  row: number;
  /** More cost; -1: nobody can step it so. */
  extra: number;
  /** Row, column and limb. */
  changes: [number, number, number][];
};

/** The feet; their numbers are arrays row.*. */
export type Play = {
  columns: number;
  preset: string;
  total: number;
  /** Of moves. */
  names: string[];
  /** Numbers of names, by row. */
  moves: number[][];
};

/** The song's file, where it is in the page. */
export type Music = {
  type: string;
  bytes: number;
};

/** Kind, count, row length, rounds of differences, offset in the block. */
export type ArrayEntry = ["u1" | "i1" | "u2" | "i2" | "u4" | "i4" | "f4" | "f8", number, number, 0 | 1 | 2, number];

/** The JSON at the head of a page's data block: a 32-bit length, this, then the arrays that it names (page.md). */
export type PageDoc = {
  schema: 2;
  words: Words;
  pad: Pad;
  style: Style;
  look: Look;
  stage: Stage;
  body: Body;
  /** Two players of one chart. */
  pair: boolean;
  motions: MotionDoc[];
  second: SecondDancer;
  /** Second of each beat from 0. */
  beats: number[];
  findings: Finding[];
  passages: Passage[];
  flips: Flip[];
  play: Play;
  music?: Music;
  /** By name. */
  arrays: Record<string, ArrayEntry>;
  /** In which the page begins; empty: the browser's. */
  language: string;
  /** The page's labels, by language and name. */
  languages: Record<string, Record<string, string>>;
  /** By file name. */
  shaders: Record<string, string>;
};
