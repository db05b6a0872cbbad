#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "html/recording.hpp"
#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::html {

/// What a page tells besides the run itself.
struct PageText {
  std::string title;
  std::string ended;  ///< why the run ended before its time; empty: it did not
};

/// Whether three.js was there when this was built; without it there are no pages.
bool can_write_pages();

/// Writes a run as one HTML file that needs nothing else: the sphere on its ground in motion, its switches,
/// its speed, spin and energy. It has less than 2 MB, whatever the run and the ground are.
/// @param scene  the sphere and the ground, and where no state was recorded the initial state
/// @return       what the page leaves out, a sentence each, as it says itself
std::vector<std::string> write_page(const scene::Scene& scene, const Recording& recording,
                                    const PageText& text, std::ostream& out);

}  // namespace hybrid_sphere::html
