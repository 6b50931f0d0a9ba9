#pragma once
// Work of joints beyond that of their springs, dampers and friction.

#include "cable/certificate/evidence.h"

namespace sheave::certify {

struct JointWork {
  double unexplained = 0.0;  ///< on the bodies and their springs [J]
  double flow = 0.0;         ///< energy that passed through the joint [J]
};

[[nodiscard]] JointWork work_of(const Evidence& evidence, const JointEvidence& joint);

}  // namespace sheave::certify
