#pragma once

#include <string>
#include <vector>

#include "scene/cell_map.hpp"

namespace hybrid_sphere::scene {

/// The rough cells of a map that a YAML file of map_server describes: those that the node makes rough if it
/// gets the OccupancyGrid of map_server on ~surface_grid, with the default ~grid_threshold.
/// @param tree            the name of the file
/// @param path            put before the keys in error messages
/// @param base_directory  the directory to which a relative name refers; empty: the working directory
/// @param warnings        gets the keys of the file that map_server does not know
/// @throws SceneError     also if a file cannot be read
CellMap read_map_server_file(const Tree& tree, const std::string& path, const std::string& base_directory,
                             std::vector<std::string>& warnings);

}  // namespace hybrid_sphere::scene
