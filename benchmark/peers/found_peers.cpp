#include "peer.hpp"

namespace hybrid_sphere::peers {

std::vector<std::unique_ptr<Peer>> found_peers() {
  std::vector<std::unique_ptr<Peer>> peers;
#ifdef PEER_ODE
  peers.push_back(make_ode());
#endif
#ifdef PEER_BULLET
  peers.push_back(make_bullet());
#endif
#ifdef PEER_MUJOCO
  peers.push_back(make_mujoco_euler());
  peers.push_back(make_mujoco_rk4());
#endif
#ifdef PEER_DART
  peers.push_back(make_dart());
#endif
#ifdef PEER_SIMBODY
  peers.push_back(make_simbody());
#endif
#ifdef PEER_SICONOS
  peers.push_back(make_siconos());
#endif
  return peers;
}

}  // namespace hybrid_sphere::peers
