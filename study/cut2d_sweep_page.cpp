#include "study/cut2d_sweep_page.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/number_text.h"
#include "study/study_text.h"
#include "study/svg.h"

namespace trocar {

namespace {

constexpr double chart_width = 640, height = 330, left = 60, right = 620, top = 40, bottom = 270;
constexpr std::array<const char*, n_cut2d_settings> setting_colours = {"#8a6d1f", "#1f5fbf",
                                                                       "#c01818"};

double x_of(const Cut2dParameter& parameter, std::size_t k) {
  const auto n = static_cast<double>(parameter.values.size());
  return left + (right - left) * (static_cast<double>(k) + 0.5) / n;
}

double y_of(double ratio) {
  return bottom - (bottom - top) * std::clamp(ratio, 0.0, 1.0);
}

std::string axes_svg(const Cut2dParameter& parameter) {
  std::string text;
  for (int k = 0; k <= 5; ++k) {
    const double y = y_of(0.2 * k);
    text += svg_line({left, y}, {right, y}, {"#dddddd", 1, ""});
    text +=
        svg_text({left - 8, y + 4}, {.text = with_decimals(0.2 * k, 1), .anchor = SvgAnchor::end});
  }
  for (std::size_t k = 0; k < parameter.values.size(); ++k)
    text += svg_text({x_of(parameter, k), bottom + 20},
                     {.text = parameter.values[k].label, .anchor = SvgAnchor::middle});
  text += svg_text({left, 24}, {.text = parameter.name + ": " + parameter.meaning, .size = 14});
  text += svg_text({18, bottom}, {.text = "stable step after / before", .is_upright = true});
  return text;
}

std::string curve_svg(const Cut2dParameter& parameter, int setting, double Cut2dSample::*member,
                      const std::string& dash) {
  std::vector<SvgPoint> points;
  std::string markers;
  const std::string colour = setting_colours[setting];
  for (std::size_t k = 0; k < parameter.values.size(); ++k) {
    const Cut2dSample& sample = parameter.values[k].samples[setting];
    points.push_back({x_of(parameter, k), y_of(sample.*member)});
    markers += svg_marker(points.back(), setting, colour, dash.empty(), "");
  }
  return svg_polyline(points, {colour, 1.8, dash}) + markers;
}

std::string legend_svg() {
  std::string text;
  for (int s = 0; s < n_cut2d_settings; ++s) {
    const double x = left + 200.0 * s;
    const char* colour = setting_colours[s];
    text += svg_marker({x, bottom + 44}, s, colour, true, "");
    text += svg_text({x + 10, bottom + 48}, {.text = cut2d_setting_names[s], .colour = colour});
  }
  return text;
}

// The value with the best 5 % quantile in the robust mode.
const Cut2dValue& best_value(const Cut2dParameter& parameter) {
  return *std::max_element(parameter.values.begin(), parameter.values.end(),
                           [](const Cut2dValue& a, const Cut2dValue& b) {
                             return a.samples.back().low < b.samples.back().low;
                           });
}

bool is_default(const Cut2dValue& value, int setting) {
  const CutPlaneOptions none = cut2d_setting(setting);
  CutPlaneOptions set = none;
  value.set(set);
  return set == none;
}

std::string sentence(const Cut2dParameter& parameter) {
  const Cut2dValue& best = best_value(parameter);
  std::string text = "Robust mode: best 5 % quantile " + with_decimals(best.samples.back().low, 3) +
                     " at " + best.label;
  for (const Cut2dValue& value : parameter.values)
    if (is_default(value, n_cut2d_settings - 1))
      text += "; the default " + value.label + " has " + with_decimals(value.samples.back().low, 3);
  return text + ".\n";
}

}  // namespace

std::string parameter_svg(const Cut2dParameter& parameter) {
  std::string content = axes_svg(parameter);
  for (int s = 0; s < n_cut2d_settings; ++s)
    content += curve_svg(parameter, s, &Cut2dSample::median, "") +
               curve_svg(parameter, s, &Cut2dSample::low, "6 4");
  return svg_document(chart_width, height, "Plane cut: " + parameter.name, content + legend_svg());
}

std::string parameter_file(const Cut2dParameter& parameter) {
  std::string name = parameter.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return "cutting_" + name + ".svg";
}

std::string parameter_section(const Cut2dParameter& parameter) {
  std::string text = "## " + parameter.name + "\n\n" + parameter.meaning +
                     ".\n\n| value | mode | median | 5 % | worst | refused | sigma of areas | "
                     "time of a cut |\n|---|---|---:|---:|---:|---:|---:|---:|\n";
  for (const Cut2dValue& value : parameter.values)
    for (int s = 0; s < n_cut2d_settings; ++s) {
      const Cut2dSample& sample = value.samples[s];
      const char* mark = is_default(value, s) ? "**" : "";
      text += "| " + (mark + value.label + mark) + " | " + cut2d_setting_names[s] + " | " +
              with_decimals(sample.median, 3) + " | " + with_decimals(sample.low, 3) + " | " +
              with_decimals(sample.worst, 3) + " | " + std::to_string(sample.n_refused) + " | " +
              with_decimals(sample.area_sigma, 3) + " | " + with_decimals(1e6 * sample.seconds, 0) +
              " us |\n";
    }
  return text + "\n" + sentence(parameter);
}

std::string sweep_page(const std::vector<Cut2dParameter>& parameters, int n_cuts_a_mesh) {
  std::string text =
      "# Parameters of the plane cut\n\n"
      "Serby, Harders and Szekely (2001) left it to future work to analyse how the parameters of "
      "their combined mass-spring and particle system depend on each other. Here each one is "
      "varied with the others at their defaults (bold), over " +
      std::to_string(4 * n_cuts_a_mesh) +
      " random straight cuts with both ends inside, on the meshes of configurations 1 to 4. The "
      "measure is the bound of the stable time step, the least 2 A / sqrt(sum l^2) of all "
      "elements, after the cut over before: 1 means that the cut costs no time step. Refused "
      "cuts leave the tissue joined.\n\n"
      "Written by `trocar cut2d --sweep --cuts " +
      std::to_string(n_cuts_a_mesh) + " --docs docs`.\n";
  for (const Cut2dParameter& parameter : parameters)
    text += "\n" + parameter_section(parameter) + "\n![" + parameter.name + "](images/" +
            parameter_file(parameter) + ")\n";
  return text;
}

}  // namespace trocar
