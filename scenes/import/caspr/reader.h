#pragma once
// Reads a cable robot of CASPR into the Model of MJCF: the links of its _bodies.xml, and the default
// set of cables of its _cables.xml.
//
// A link has the frame of the joint to its parent; attachments count from the joint or from the
// centre of mass.

#include "scenes/import/attributes.h"
#include "scenes/import/mjcf/model.h"
#include "scenes/import/opensim/properties.h"

namespace sheave::import::caspr {

/// Whether the first element of a text is that of one of the two files.
[[nodiscard]] bool is_part(const xml::Element& root);

/// The tree of the other file of a robot, in the same folder: NAME_cables.xml of NAME_bodies.xml and
/// the other way round. Its fault if it cannot be had.
[[nodiscard]] xml::Tree other_part(const xml::Element& root, const std::string& file_name,
                                   const Options& options, const Limits& limits);

/// The model of both trees, in any order; check log.failed().
[[nodiscard]] mjcf::Model read_model(const xml::Element& first, const xml::Element& second,
                                     Log& log);

/// Reads <links>.
void read_links(const xml::Element& root, mjcf::Model& model, opensim::Properties& properties,
                Log& log);
/// Reads the default set of <cables>.
void read_cables(const xml::Element& root, mjcf::Model& model, opensim::Properties& properties,
                 Log& log);

}  // namespace sheave::import::caspr
