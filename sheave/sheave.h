#pragma once
// All of Sheave that a program needs to build worlds, to load them, and to hold them while they
// live. Programs write #include <sheave/sheave.h>, or include single headers as <sheave/...>:
//
//   cable/live_world.h    LiveWorld, a world that a program holds: step, read, control, edit
//   scenes/load_world.h   load(): a LiveWorld from a scene file
//   engine/model.h        Model: gravity, bodies, joints, colliders, ground, settings of the step
//   engine/body.h         BodyDef; engine/joint.h JointDef; engine/shape.h Shape
//   engine/joints/        one header per joint type
//   engine/shapes/        one header per shape
//   cable/cable.h         CableDef; cable/link.h LinkDef; cable/links/ one header per link type
//   cable/edit.h          Edit: a list of changes for LiveWorld::edit()
//   cable/simulation.h    Simulation, which is LiveWorld without names; engine/world.h World, which
//                         has no cables
//   cable/cable_report.h  tensions and lengths; cable/cable_polyline.h the lines to draw;
//                         engine/joint_report.h forces and coordinates
//   cable/run_check.h     the verdict of a run; cable/certificate.h the check of a substep
//   engine/state.h        State: snapshot, hash, bytes for a file
//   engine/result.h       Result and Errors
//   engine/vector.h       Vector3, Matrix3, Quaternion, and frames
//
// These headers are not included here:
//
//   scenes/scene.h        Scene, a scene file as a value: read, write; scenes/validate.h its faults
//   scenes/control/scene_supervisor.h  create_simulation(): a Simulation of a Scene with its
//                         controllers and triggers, for LiveWorld::of()
//   scenes/generators.h   scenes that are made from parameters
//   scenes/observables.h  quantities by their names; scenes/quantity_list.h the same and
//                         expressions of them, as in `--measure`
//   statics/equilibrium.h rest of a machine; statics/start_at_rest.h a Simulation that starts there;
//                         statics/modes.h vibrations; statics/joint_space.h the coordinates of
//                         joints; statics/place_joints.h poses by these coordinates
//   live/session.h        the protocol of `sheave live`
//   measure/run_error.h   errors against a reference (measure/reference_run.h), estimates without
//                         one (measure/error_estimate.h); measure/timing.h times

#include "cable/edit.h"
#include "cable/links/attachment.h"
#include "cable/links/hybrid.h"
#include "cable/links/opening.h"
#include "cable/links/pinhole.h"
#include "cable/links/rolling.h"
#include "cable/links/sheath.h"
#include "cable/links/spool.h"
#include "cable/links/surface.h"
#include "cable/live_world.h"
#include "cable/run_check.h"
#include "cable/simulation.h"
#include "engine/joint_report.h"
#include "engine/joints/ball.h"
#include "engine/joints/coupling.h"
#include "engine/joints/cylindrical.h"
#include "engine/joints/distance.h"
#include "engine/joints/fixed.h"
#include "engine/joints/gear.h"
#include "engine/joints/hinge.h"
#include "engine/joints/plane.h"
#include "engine/joints/rack.h"
#include "engine/joints/slider.h"
#include "engine/joints/universal.h"
#include "engine/shapes/box.h"
#include "engine/shapes/capsule.h"
#include "engine/shapes/cone.h"
#include "engine/shapes/convex_hull.h"
#include "engine/shapes/cylinder.h"
#include "engine/shapes/ellipsoid.h"
#include "engine/shapes/half_space.h"
#include "engine/shapes/prism.h"
#include "engine/shapes/sphere.h"
#include "engine/shapes/torus.h"
#include "scenes/load_world.h"
