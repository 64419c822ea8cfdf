#include <gtest/gtest.h>
#include "verification_modes.h"
#include "verification_statics.h"
using namespace trocar;
TEST(Try, modes) {
  for (double nu : {.3,.49}) for (int n : {8, 12}) {
    Body body = make_box_body(hex_one_point, {.size = {.04, .04, .04}, .n = {n, n, n}, .material = {MaterialModel::linear, 3000, nu, 1000}});
    auto f = lowest_frequencies(body, 20);
    std::printf("nu %g n %d:", nu, n); for (double x : f) std::printf(" %.3f", x); std::printf("\n");
  }
  for (int n : {12, 16}) for (double nu : {.3, .49}) {
    double mu = 3000 / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu), c_d = std::sqrt((lambda + 2 * mu) / 1000);
    Body body = make_box_body(hex_one_point, {.size = Vec3(.01,.01,.01) * n, .n = {n, n, n}, .material = {MaterialModel::linear, 3000, nu, 1000}});
    std::printf("limit n %d nu %g %.5f\n", n, nu, 2 / std::sqrt(highest_omega2(body)) * c_d / .01);
  }
}
