// MuJoCo. Its contacts are soft by design; what comes nearest to rolling without slip:
// * solimp 0.9999, the hardest that it takes; solref (2 steps, 1), the stiffest that it takes: a slip is
//   gone after one step, but for one part in ten thousand, which noslip_iterations take away. The sphere
//   starts at the depth at which this contact bears its weight.
// * elliptic cone, Newton's method, tolerance 1e-15: the forces are those of the model, to rounding. More
//   than two iterations without slip change nothing.
// * a pair of geometries whose condim is 3 on rough ground and 1, frictionless, on smooth ground, from the
//   place at the beginning of the step; friction 1e7, which no reaction here comes near.
// * the integrators Euler (semi-implicit) and RK4: the one is cheaper, the other has the higher order.
#include <mujoco/mujoco.h>

#include <cstring>
#include <sstream>
#include <stdexcept>

#include "peer.hpp"
#include "rough_at.hpp"

namespace hybrid_sphere::peers {
namespace {

constexpr double impedance = 0.9999;

/// Depth at which the contact bears the weight: (1 - d) g = d k depth, k = 1/(d 2 h)^2 [m].
double resting_depth(double gravity, double step) {
  const double stiffness = 1 / std::pow(impedance * 2 * step, 2);
  return (1 - impedance) / impedance * gravity / stiffness;
}

std::string model_text(const Task& task, double step, const std::string& integrator) {
  const scene::SphereBody& sphere = task.scene.sphere;
  const Vector3d& g = task.scene.forces.gravity;
  const scene::InitialState& start = task.scene.initial_state;
  const double inertia = sphere.mass * sphere.gyration_radius * sphere.gyration_radius;
  std::ostringstream text;
  text.precision(17);
  text << "<mujoco><option timestep='" << step << "' gravity='" << g.x() << ' ' << g.y() << ' ' << g.z()
       << "' integrator='" << integrator
       << "' cone='elliptic' solver='Newton' tolerance='1e-15' iterations='20'"
       << " noslip_iterations='2' noslip_tolerance='0'/>"
       << "<worldbody><geom name='plane' type='plane' size='0 0 1' contype='0' conaffinity='0'/>"
       << "<body pos='" << start.position.x() << ' ' << start.position.y() << ' '
       << sphere.radius - resting_depth(-g.z(), step) << "'><freejoint/>"
       << "<inertial pos='0 0 0' mass='" << sphere.mass << "' diaginertia='" << inertia << ' ' << inertia
       << ' ' << inertia << "'/><geom name='ball' type='sphere' size='" << sphere.radius
       << "' contype='0' conaffinity='0'/></body></worldbody>"
       << "<contact><pair geom1='plane' geom2='ball' condim='3' friction='1e7 1e7 0 0 0' solref='" << 2 * step
       << " 1' solimp='" << impedance << ' ' << impedance << " 1'/></contact></mujoco>";
  return text.str();
}

mjModel* compile(const std::string& text) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "scene.xml", static_cast<int>(text.size()));
  std::memcpy(files->filedata[0], text.data(), text.size());
  char error[1000] = "";
  mjModel* model = mj_loadXML("scene.xml", files.get(), error, sizeof error);
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::runtime_error(error);
  return model;
}

class MujocoWorld {
 public:
  MujocoWorld(const Task& task, double step, const std::string& integrator)
      : rough_at_(task.scene.surface), model_(compile(model_text(task, step, integrator)), mj_deleteModel) {
    data_.reset(mj_makeData(model_.get()));
    const scene::InitialState& start = task.scene.initial_state;
    for (int i = 0; i < 2; ++i) data_->qvel[i] = start.velocity[i];
    for (int i = 0; i < 3; ++i)
      data_->qvel[3 + i] = start.angular_velocity[i];  // of the body, not turned yet
  }

  void advance() {
    model_->pair_dim[0] = rough_at_({data_->qpos[0], data_->qpos[1]}) ? 3 : 1;
    mj_step(model_.get(), data_.get());
  }

  Sample look() const {
    const mjtNum* q = data_->qpos;
    const mjtNum* v = data_->qvel;
    const Quaterniond body_to_world(q[3], q[4], q[5], q[6]);
    return {{q[0], q[1]}, {{v[0], v[1]}, body_to_world * Vector3d(v[3], v[4], v[5])}};
  }

  int warnings() const {
    int count = 0;
    for (const mjWarningStat& warning : data_->warning) count += warning.number;
    return count;
  }

 private:
  RoughAt rough_at_;
  std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model_;
  std::unique_ptr<mjData, decltype(&mj_deleteData)> data_{nullptr, mj_deleteData};
};

class Mujoco final : public Peer {
 public:
  explicit Mujoco(std::string integrator) : integrator_(std::move(integrator)) {}

  std::string name() const override { return "MuJoCo " + integrator_; }

  Course run(const Task& task, double step) override {
    MujocoWorld world(task, step, integrator_);
    Course course = march(
        task, step, [&] { world.advance(); }, [&] { return world.look(); });
    if (world.warnings() > 0) course.note = "MuJoCo warns of an unstable motion";
    return course;
  }

 private:
  std::string integrator_;
};

}  // namespace

std::unique_ptr<Peer> make_mujoco_euler() { return std::make_unique<Mujoco>("Euler"); }
std::unique_ptr<Peer> make_mujoco_rk4() { return std::make_unique<Mujoco>("RK4"); }

}  // namespace hybrid_sphere::peers
