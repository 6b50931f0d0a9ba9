#include "measure/stress_map.h"

namespace sheave::measure {

StressMap StressMap::over(std::string name, std::string meaning, StressAxis x, StressAxis y,
                          const std::function<StressCell(double across, double down)>& make) {
  StressMap map{std::move(name), std::move(meaning), std::move(x), std::move(y), {}};
  for (const double down : map.y.values) {
    for (const double across : map.x.values) {
      StressCell cell = make(across, down);
      cell.x = across;
      cell.y = down;
      map.cells.push_back(std::move(cell));
    }
  }
  return map;
}

}  // namespace sheave::measure
