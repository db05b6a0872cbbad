#pragma once

#include <string>

#include "hybrid_sphere/simulation/records.hpp"

/// Rows of the two tables that `simulate` writes: comma-separated, 17 significant digits, which give back the
/// same binary64 number.
namespace hybrid_sphere::cli {

inline constexpr const char* states_header = "t,x,y,qx,qy,qz,qw,vx,vy,wx,wy,wz,stage,mode,region";
inline constexpr const char* switches_header =
    "index,t,kind,from_region,to_region,x,y,Px,Py,Lx,Ly,Lz,vx1,vy1,wx1,wy1,wz1,vx2,vy2,wx2,wy2,wz2,energy1,"
    "energy2";

/// Puts a row with its line feed at the end of `text`.
void append_row(const State& state, std::string& text);
void append_row(const Switch& event, std::string& text);

}  // namespace hybrid_sphere::cli
