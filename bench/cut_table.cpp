// Tables of bench_cut: Markdown for people, JSON for programs.
#include <algorithm>

#include "bench/machine.h"
#include "cut_result.h"

namespace trocar::cut_bench {

namespace {

struct Column {
  const char* head;
  std::string (*text)(const Row& row);
};

template <class Value>
std::vector<double> sorted(const Row& row, const Value& value) {
  std::vector<double> v;
  for (const Result& result : row.result) v.push_back(value(result));
  std::sort(v.begin(), v.end());
  return v;
}

double at(const std::vector<double>& v, double part) {
  return v.empty() ? 0 : v[std::min(v.size() - 1, std::size_t(part * double(v.size())))];
}

std::string format(const char* pattern, double a, double b = 0, double c = 0) {
  char text[96];
  std::snprintf(text, sizeof text, pattern, a, b, c);
  return text;
}

template <class Value>
double total(const Row& row, const Value& value) {
  double sum = 0;
  for (const Result& result : row.result) sum += value(result);
  return sum;
}

std::vector<double> deviations(const Row& row) {
  std::vector<double> v;
  for (const Result& result : row.result)
    v.insert(v.end(), result.deviation.begin(), result.deviation.end());
  std::sort(v.begin(), v.end());
  return v;
}

template <class Value>
std::string low_values(const Row& row, const char* pattern, const Value& value) {
  const std::vector<double> v = sorted(row, value);
  return format(pattern, at(v, 0), at(v, 0.05), at(v, 0.5));
}

std::string share(const Row& row) {
  const double n = double(row.result.size());
  return format("%.0f/%.0f", total(row, [](const Result& r) { return r.is_right(); }), n);
}

std::string faults(const Row& row) {
  return format("%.0f, %.0f", total(row, [](const Result& r) { return r.n_inverted; }),
                total(row, [](const Result& r) { return !r.fault.empty(); }));
}

std::string refusals(const Row& row) {
  return format("%.0f in %.0f", total(row, [](const Result& r) { return r.n_refused; }),
                total(row, [](const Result& r) { return r.n_refused > 0; }));
}

std::string rungs(const Row& row) {
  return format("%.0f, %.0f, %.0f", total(row, [](const Result& r) { return r.n_turned; }),
                total(row, [](const Result& r) { return r.n_chips; }),
                total(row, [](const Result& r) { return r.n_beside; })) +
         format(", %.0f, %.0f", total(row, [](const Result& r) { return r.n_pulled_back; }),
                total(row, [](const Result& r) { return r.n_inserted; }));
}

std::string elements(const Row& row) {
  return format("%.0f, %.0f", total(row, [](const Result& r) { return std::max(0, r.n_added); }),
                total(row, [](const Result& r) { return std::max(0, -r.n_added); }));
}

std::string hexahedra(const Row& row) {
  const auto mean = [&](auto value) { return total(row, value) / double(row.result.size()); };
  if (mean([](const Result& r) { return r.n_hexahedra; }) == 0) return "-";
  return format("%.0f: %.0f, %.0f", mean([](const Result& r) { return r.n_hexahedra; }),
                mean([](const Result& r) { return r.n_reshaped; }),
                mean([](const Result& r) { return r.n_converted; }));
}

std::string deviation(const Row& row) {
  const std::vector<double> v = deviations(row);
  return format("%.3f, %.2f", at(v, 0.95), at(v, 1));
}

std::string errors(const Row& row) {
  const double of_regions = at(sorted(row, [](const Result& r) { return r.region_error; }), 1);
  return format("%.0e, %.0e", at(sorted(row, [](const Result& r) { return r.volume_error; }), 1),
                at(sorted(row, [](const Result& r) { return r.mass_error; }), 1)) +
         (of_regions < 0 ? "" : format("; regions' %.0e", of_regions));
}

std::string times(const Row& row) {
  const double seconds = total(row, [](const Result& r) { return r.seconds; });
  // A node and its copy are one node of the cut.
  const double n_nodes =
      total(row, [](const Result& r) { return double(r.deviation.size()) - r.n_duplicated; });
  return format("%.1f, %.0f", 1e3 * seconds / double(row.result.size()),
                1e6 * seconds / std::max(1.0, n_nodes));
}

constexpr Column columns[] = {
    {"mesh", [](const Row& row) { return row.family; }},
    {"cut", [](const Row& row) { return row.kind; }},
    {"right", share},
    {"inverted, unsound", faults},
    {"refused facets in cuts", refusals},
    {"rungs: turned, chips, beside, pulled back, nodes on edges", rungs},
    {"elements added, dissolved", elements},
    {"hexahedra: reshaped, converted", hexahedra},
    {"body's step min/p5/median",
     [](const Row& row) {
       return low_values(row, "%.2f/%.2f/%.2f", [](const Result& r) { return r.body_ratio; });
     }},
    {"cut's step min/p5/median",
     [](const Row& row) {
       return low_values(row, "%.2f/%.2f/%.2f", [](const Result& r) { return r.cut_ratio; });
     }},
    {"dihedral min/p5/median",
     [](const Row& row) {
       return low_values(row, "%.0f/%.0f/%.0f", [](const Result& r) { return r.least_dihedral; });
     }},
    {"deviation p95, max", deviation},
    {"volume, mass error", errors},
    {"ms a cut, us a node", times},
    {"subdivision: elements x",
     [](const Row& row) {
       return format("%.2f", at(sorted(row, [](const Result& r) { return r.split_elements; }), .5));
     }},
    {"its step p5/median", [](const Row& row) {
       const auto v = sorted(row, [](const Result& r) { return r.split_ratio; });
       return format("%.4f/%.4f", at(v, 0.05), at(v, 0.5));
     }}};

}  // namespace

void print_head(std::FILE* file) {
  for (const Column& column : columns) std::fprintf(file, "| %s ", column.head);
  std::fprintf(file, "|\n");
  for (std::size_t k = 0; k < std::size(columns); ++k) std::fprintf(file, "|---");
  std::fprintf(file, "|\n");
}

void print_row(const Row& row, std::FILE* file) {
  for (const Column& column : columns) std::fprintf(file, "| %s ", column.text(row).c_str());
  std::fprintf(file, "|\n");
  std::fflush(file);
}

void print_json(const std::vector<Row>& rows, std::FILE* file) {
  const char* comma = "";
  std::fprintf(file, "{\"peak_gflops\": %.1f, \"triad_gbytes\": %.1f, \"cuts\": [", peak_gflops(),
               triad_gbytes());
  for (const Row& row : rows)
    for (const Result& r : row.result) {
      std::fprintf(
          file,
          "%s\n{\"mesh\": \"%s\", \"cut\": \"%s\", \"right\": %s, \"fault\": \"%s\", "
          "\"inverted\": %d, \"pieces\": %d, \"pieces_exact\": %d, \"pieces_thin\": %d, "
          "\"refused\": %d, \"turned\": %d, \"chips\": %d, \"beside\": %d, \"pulled_back\": %d, "
          "\"inserted\": %d, \"inverted_by_move\": %d, \"edits\": %d, \"opened\": %d, "
          "\"duplicated\": %d, "
          "\"added\": %d, \"hexahedra\": %d, \"reshaped\": %d, \"converted\": %d, "
          "\"body_step_ratio\": %.6g, \"cut_step_ratio\": %.6g, "
          "\"dihedral\": %.6g, \"deviation_max\": %.6g, \"volume_error\": %.3g, "
          "\"mass_error\": %.3g, \"seconds\": %.6g, \"longest_advance\": %.6g, "
          "\"subdivision_elements\": %.6g, \"subdivision_step_ratio\": %.6g}",
          comma, row.family.c_str(), row.kind.c_str(), r.is_right() ? "true" : "false",
          r.fault.c_str(), r.n_inverted, r.n_pieces, r.n_exact, r.n_thin, r.n_refused, r.n_turned,
          r.n_chips, r.n_beside, r.n_pulled_back, r.n_inserted, r.n_inverted_by_move, r.n_edits,
          r.n_opened, r.n_duplicated, r.n_added, r.n_hexahedra, r.n_reshaped, r.n_converted,
          r.body_ratio, r.cut_ratio, r.least_dihedral,
          r.deviation.empty() ? 0.0 : *std::max_element(r.deviation.begin(), r.deviation.end()),
          r.volume_error, r.mass_error, r.seconds, r.longest_advance, r.split_elements,
          r.split_ratio);
      comma = ",";
    }
  std::fprintf(file, "\n]}\n");
}

}  // namespace trocar::cut_bench
