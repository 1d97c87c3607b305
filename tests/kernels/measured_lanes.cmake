# Lane sources that are tested here and timed in bench/micro, compiled once for both: what is measured is what is tested.
include_guard(GLOBAL)
add_lane_sources(measured_lanes
  ${CMAKE_CURRENT_LIST_DIR}/math_entries.cpp
  ${CMAKE_CURRENT_LIST_DIR}/sampler_entries.cpp
  ${CMAKE_CURRENT_LIST_DIR}/warp_entries.cpp)
