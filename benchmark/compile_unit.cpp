// The unit of compile time: what g++ -O2 takes for the headers of roscpp and Eigen and one dense
// decomposition.
#include <ros/ros.h>

#include <Eigen/Dense>

int main(int argc, char** argv) {
  ros::init(argc, argv, "compile_unit");
  const ros::NodeHandle node;
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(9, 9);
  return static_cast<int>(matrix.lu().determinant());
}
