#pragma once

#include <string_view>

/// The files that a page is made of, as they were when this was built.
namespace hybrid_sphere::html::embedded {

std::string_view page();      ///< page.html
std::string_view style();     ///< page.css
std::string_view script();    ///< page_*.js, one after another
std::string_view licence();   ///< of three.js
std::string_view three();     ///< three.js, empty where it was missing
std::string_view controls();  ///< its OrbitControls.js, empty where it was missing

}  // namespace hybrid_sphere::html::embedded
