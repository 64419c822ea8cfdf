#include "verification_figure.h"

#include <cstdio>

namespace trocar {

bool is_report() {
  return std::getenv("TROCAR_VERIFICATION_RECORD") != nullptr;
}

double error_of(const Figure& figure) {
  const double difference = figure.number - figure.reference;
  return figure.reference == 0 ? difference : difference / std::abs(figure.reference);
}

double two_mesh_tolerance(double coarse, double fine, double reference, double order) {
  return 3 * std::abs((coarse - fine) / reference) / (std::exp2(order) - 1);
}

void record(const Figure& figure) {
  const char* path = std::getenv("TROCAR_VERIFICATION_RECORD");
  std::FILE* file = path == nullptr ? nullptr : std::fopen(path, "a");
  if (file == nullptr) return;
  std::fprintf(file,
               "{\"problem\": \"%s\", \"quantity\": \"%s\", \"mesh\": \"%s\", \"number\": %.10g, "
               "\"reference\": %.10g, \"error\": %.4g, \"tolerance\": %g, \"source\": \"%s\", "
               "\"order\": %.3g}\n",
               figure.problem.c_str(), figure.quantity.c_str(), figure.mesh.c_str(), figure.number,
               figure.reference, error_of(figure), figure.tolerance, figure.source.c_str(),
               figure.order);
  std::fclose(file);
}

void check_figure(const Figure& figure) {
  std::printf("%s, %s, %s: %.8g, reference %.8g, error %.2g\n", figure.problem.c_str(),
              figure.quantity.c_str(), figure.mesh.c_str(), figure.number, figure.reference,
              error_of(figure));
  record(figure);
  EXPECT_LE(std::abs(error_of(figure)), figure.tolerance)
      << figure.problem << ", " << figure.quantity << ", " << figure.mesh;
}

}  // namespace trocar
