// The description of a machine, independent of its motion: the JSON that view/machine_json.cpp
// writes. Lengths [m]; positions are in the world frame unless a body's frame is mentioned.

import type { Quaternion, Vector3 } from './vector';

/** Index of a body; -1 is the world, which is at rest. */
export type BodyIndex = number;

export type Shape =
  | { type: 'box'; size: Vector3 }
  | { type: 'sphere'; radius: number }
  /** The axis of cylinders, capsules and sheaves is z. */
  | { type: 'cylinder'; radius: number; length: number }
  | { type: 'capsule'; radius: number; length: number }
  | {
      type: 'sheave';
      radius: number;
      length: number;
      cable_radius: number;
      groove_width: number;
      spokes: number;
    }
  | { type: 'mesh'; vertices: Vector3[]; triangles: [number, number, number][] };

/** A solid fixed to a body; position and orientation in the body's frame. Colours are "#rrggbb". */
export interface Part {
  body: BodyIndex;
  shape: Shape;
  position: Vector3;
  orientation: Quaternion;
  color: string;
}

/** A round bar fixed to a body; its ends are in the body's frame. */
export interface Bar {
  body: BodyIndex;
  start: Vector3;
  end: Vector3;
  radius: number;
  color: string;
}

/** A line between points of two bodies. */
export interface JointLine {
  kind: 'rod' | 'string' | 'spring' | 'telescope' | 'bumper';
  body_a: BodyIndex;
  body_b: BodyIndex;
  start: Vector3;
  end: Vector3;
  side: Vector3;
  length: number;
}

/** The appearance of one joint until it breaks. */
export interface JointPiece {
  joint: number;
  parts: Part[];
  bars: Bar[];
  lines: JointLine[];
}

export interface Camera {
  position: Vector3;
  target: Vector3;
  up: Vector3;
  /** Full vertical angle of a perspective camera [rad]. */
  vertical_fov?: number;
  /** Height of the picture of an orthographic camera [m]. */
  height?: number;
}

/** A pose of the camera at a time [s]. */
export interface CameraKey extends Camera {
  time: number;
}

export interface Annotation {
  kind: 'title' | 'caption' | 'arrow';
  text: string;
  /** First and last time [s]; without a last one to the end. */
  from: number;
  to?: number;
  /** The point of an arrow, in the frame of the body. */
  body?: BodyIndex;
  point?: Vector3;
}

export interface MachineEvent {
  /** [s] */
  time: number;
  /** "leave", "touch", "cut", "joint broken", "trigger", ... */
  kind: string;
  text: string;
}

export interface Cable {
  name: string;
  closed: boolean;
  links: { type: string; body: BodyIndex; winding_room: number }[];
  spans: number;
  /** Number of possible wraps on bodies outside the list of links. */
  wraps: number;
}

export interface Machine {
  format: 'sheave-view/1';
  name: string;
  description: string;
  gravity: Vector3;
  /** Duration of a step [s]. */
  dt: number;
  /** Duration of the run [s]. */
  duration: number;
  bodies: { name: string; mobility: string }[];
  joints: { name: string; type: string; bodies: [BodyIndex, BodyIndex] }[];
  cables: Cable[];
  parts: Part[];
  bars: Bar[];
  joint_pieces: JointPiece[];
  /** The radius of rods [m]. */
  joint_unit: number;
  cable_radius: number;
  /** The top of the colour scale [N], for the whole run. */
  tension_max: number;
  floor: { point: Vector3; normal: Vector3; grid_spacing: number; color: string } | null;
  camera: Camera;
  /** In the order of time; empty for a camera that stands. */
  camera_path: CameraKey[];
  annotations: Annotation[];
  bounds: { min: Vector3; max: Vector3 };
  /** The verdict of the run's certificate; a machine that runs in the page has none. */
  verdict?: { clean: boolean; text: string };
}

/** A number that changes during a run. */
export interface Channel {
  /** A column of `sheave run --out`, or a further channel for the picture. */
  name: string;
  unit: string;
  /** Not a column of a table: only the picture needs it. */
  hidden: boolean;
}
