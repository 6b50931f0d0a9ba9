#include "cable/links/opening.h"

#include "cable/link_geometry.h"
#include "cable/wrap_candidate.h"
#include "engine/body_set.h"

namespace sheave {

std::span<const Field> OpeningLink::field_table() {
  static const std::array table{
      field<&OpeningLink::shape>("shape", "", between(0, 4095), optional,
                                 "which of the body's shapes, from 0: a sphere or a cylinder"),
  };
  return table;
}

Result<LinkGeometry> OpeningLink::compile(const BodySet& bodies, const std::string& path) const {
  const int index = bodies.index(body);
  const std::string name = "\"" + bodies.name(index) + "\"";
  const int shapes = body.is_world() ? 0 : static_cast<int>(bodies.definition(index).shapes.size());
  if (shapes > 0 && shape >= shapes) {
    return Error{path + "/shape", name + " has " + std::to_string(shapes) +
                                      (shapes == 1 ? " shape" : " shapes") +
                                      "; the first one has the number 0"};
  }
  std::optional<SmoothSurface> surface;
  if (shapes > 0) surface = smooth_surface(bodies, index, shape);
  if (!surface || !(surface->is_ball() || surface->form == SurfaceForm::cylinder)) {
    return Error{path + "/body", "an opening needs a sphere or a cylinder; " + name +
                                     (shapes == 0 ? " has no shape" : " has another shape there") +
                                     "; choose one by \"shape\", or use a \"pinhole\""};
  }
  LinkGeometry link;
  link.body = link.carrier = index;
  link.mounted = bodies[index].mount >= 0;
  link.given_stored_length = 0.0;
  link.slides = true;
  link.friction = 0.0;
  link.center = surface->center;
  link.opening = std::make_shared<const SmoothSurface>(*surface);
  return link;
}

}  // namespace sheave
