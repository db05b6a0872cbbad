#include "integration/radau.hpp"

#include <array>
#include <complex>

namespace hybrid_sphere::integration {
namespace {

using SquareTable = std::array<std::array<double, Radau::stages>, Radau::stages>;

// A: the integrals of the basis from 0 to the nodes, as a Gauss rule with five nodes computes them to the
// last bit. Radau.IntegratesPolynomials checks them.
constexpr SquareTable slopes{{
    {0x1.2b00db6e3fa2cp-4, -0x1.b6081b30682ap-6, 0x1.3200b8a1aa036p-6, -0x1.a605c5bc79bfbp-7,
     0x1.4a7ccd96a885ep-8},
    {0x1.3aee82311a74ep-3, 0x1.2b72b35cc066ep-3, -0x1.2a8dccf20f1a4p-5, 0x1.5be1ebec3e8bbp-6,
     -0x1.040878141910dp-7},
    {0x1.1ed95fc4c15b4p-3, 0x1.3224706ef9eacp-2, 0x1.5736d75c3ae71p-3, -0x1.16465e9a3154bp-5,
     0x1.669f591dfd1b3p-7},
    {0x1.28be58d5a7ef4p-3, 0x1.1b22d582aaa26p-2, 0x1.4d9df880051b7p-2, 0x1.07b19ee2f3ab7p-3,
     -0x1.015ff99971365p-6},
    {0x1.26534b9cb85e1p-3, 0x1.201bca8e66374p-2, 0x1.3f4f73b8d3268p-2, 0x1.c8eab2b61c948p-3,
     0x1.47ae147ae147p-5},
}};

// A^-1 and its eigenvectors, as Eigen computes them from A (PartialPivLU, EigenSolver), to the last bit. They
// are constants because compiling these decompositions takes longer than everything else that uses them.
// Radau.KnowsTheEigenvectorsOfItsInverse checks them against A.
constexpr SquareTable inverse{{
    {0x1.1830877b703d5p+3, 0x1.722b2cf57bb01p+1, -0x1.c0186e6b2b20fp-1, 0x1.994c52709277bp-2,
     -0x1.11d489880c49ap-3},
    {-0x1.ca540fccceae1p+2, 0x1.ce5b1c16f92f1p+0, 0x1.2e90e7e6cbc0ep+1, -0x1.bb5758d9cb3cep-1,
     0x1.18ec14c05e2c2p-2},
    {0x1.07d18e2e54ad5p+2, -0x1.1fbebe9d67f71p+2, 0x1.b6a9ef2aa91c2p-1, 0x1.42585742d8baep+1,
     -0x1.506a879a9f938p-1},
    {-0x1.f078095074d22p+1, 0x1.b252cd53396d1p+1, -0x1.4c0dc70461248p+2, 0x1.299760f060af2p-1,
     0x1.67ad8b5edc46fp+1},
    {0x1.0d3294490d4dp+3, -0x1.be18ad1c7231dp+2, 0x1.18de1e9b82aa9p+3, -0x1.23822e2b2b6fbp+4,
     0x1.a00000000000bp+3},
}};

/// An eigenvalue of A^-1, its eigenvector of unit length (a column of V), and its row of V^-1.
struct Mode {
  std::complex<double> eigenvalue;
  std::array<std::complex<double>, Radau::stages> vector;
  std::array<std::complex<double>, Radau::stages> inverse_row;
};

/// Those with an imaginary part >= 0. The other two are the conjugates of the first and of the last.
constexpr std::array<Mode, 3> modes{{
    {{0x1.d3edcaaa04f89p+1, 0x1.a2cc95da1852dp+2},
     {{{-0x1.3a7260424273ep-5, -0x1.b78b9b6ec3a1ep-7},
       {0x1.6c4c220a4c21dp-4, 0x1.583c7d39d3982p-8},
       {-0x1.62c73ccf4a864p-3, 0x1.e97e65cfb928cp-4},
       {-0x1.5855be50fac12p-3, -0x1.e3078b8d399dep-2},
       {0x1.bcb86b4ba45dbp-2, -0x1.6c7741c9dfedap-1}}},
     {{{-0x1.ff21cbc69dfap-3, 0x1.f3f8296a48fb4p+1},
       {0x1.bcb6bc9ef4e7ap+1, 0x1.1b5b59a2290dp+0},
       {-0x1.a78ce4e9da49ap-2, -0x1.e160afbc0eeccp+0},
       {-0x1.1ca9fc035c1aep-2, 0x1.d0aedcbacb1c2p-1},
       {0x1.2930ee5e9e7f7p-3, -0x1.1edafef884fd8p-2}}}},
    {{0x1.92595ee31239fp+2, 0x0p+0},
     {{{0x1.9a2d1fb890788p-7, 0x0p+0},
       {0x1.87084a1343951p-10, 0x0p+0},
       {0x1.2aef0b4499d63p-4, 0x0p+0},
       {0x1.8536b0c13834fp-2, 0x0p+0},
       {0x1.d80da0c71ef16p-1, 0x0p+0}}},
     {{{0x1.e0aa42ea49a4ep+4, 0x1.310fffc905e48p-47},
       {0x1.bbaef6abc662bp+3, 0x1.604a14b0733b8p-48},
       {0x1.bd70bb1dde119p+1, 0x1.678f230c755b4p-51},
       {-0x1.0831ba83d7f37p+0, -0x1.9039792482684p-52},
       {0x1.9bcd9bd554f64p-1, 0x1.6f1b2d02a9d2cp-53}}}},
    {{0x1.6cdc6b3974682p+2, 0x1.9ae9fbb26646ap+1},
     {{{0x1.fb09af81a6549p-8, 0x1.db7d92a2e9e14p-7},
       {-0x1.7eff3bc92c61ep-6, -0x1.20bdb4b1e54bdp-9},
       {-0x1.f9df3b516a8e9p-5, -0x1.6f188ea967144p-5},
       {-0x1.98ee85e17980ep-6, -0x1.a50a72ed3a718p-2},
       {0x1.658988de4a4a4p-2, -0x1.ace87b1b46d59p-1}}},
     {{{-0x1.4fe504d91c7f9p+1, -0x1.2a0b55f0d5b7p+4},
       {-0x1.13b436d68474bp+3, -0x1.b1f61e2ae3de9p+2},
       {-0x1.029a46aaba3cep+0, 0x1.45f02eea4aee2p-2},
       {-0x1.40403391ad1b8p+0, 0x1.d94f4cc7c7e0bp-2},
       {0x1.4a5ebee5f326p-1, 0x1.8a4740e2561aap-5}}}},
}};

/// Sets eigenvalue `k`, its eigenvector and its row of the inverse.
void set_mode(Radau& method, Eigen::Index k, const Mode& mode, bool conjugate) {
  const auto value = [conjugate](const std::complex<double>& z) { return conjugate ? std::conj(z) : z; };
  method.eigenvalues[k] = value(mode.eigenvalue);
  for (std::size_t i = 0; i < mode.vector.size(); ++i) {
    method.vectors(Eigen::Index(i), k) = value(mode.vector[i]);
    method.vectors_inverse(k, Eigen::Index(i)) = value(mode.inverse_row[i]);
  }
}

Radau make_radau() {
  Radau method;
  // (1 + x)/2 for the zeros x of P_5 - P_4, Legendre's polynomials.
  method.nodes << 0.057104196114517682193, 0.276843013638123827680, 0.583590432368916820180,
      0.860240135656219447550, 1;
  for (Eigen::Index i = 0; i < Radau::stages; ++i) {
    for (Eigen::Index j = 0; j < Radau::stages; ++j) {
      method.slopes(i, j) = slopes[std::size_t(i)][std::size_t(j)];
      method.inverse(i, j) = inverse[std::size_t(i)][std::size_t(j)];
    }
    method.start[i] = method.basis(i, 0);
  }
  set_mode(method, 0, modes[0], false);
  set_mode(method, 1, modes[0], true);
  set_mode(method, 2, modes[1], false);
  set_mode(method, 3, modes[2], false);
  set_mode(method, 4, modes[2], true);
  method.real_eigenvalue = modes[1].eigenvalue.real();
  return method;
}

}  // namespace

double Radau::basis(Eigen::Index i, double s) const {
  double product = 1;
  for (Eigen::Index k = 0; k < stages; ++k) {
    if (k != i) product *= (s - nodes[k]) / (nodes[i] - nodes[k]);
  }
  return product;
}

const Radau& radau() {
  static const Radau method = make_radau();
  return method;
}

}  // namespace hybrid_sphere::integration
