#include "study/study_plot.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "study/study_advice.h"
#include "study/study_text.h"
#include "study/svg.h"

namespace trocar {

namespace {

constexpr double width = 1080, panel_top = 78, panel_bottom = 430, legend_row = 22;
// Their lightness differs too, for prints in grey.
constexpr const char* colours[] = {"#1f2d7a", "#d1495b", "#2a9d5c", "#e0a100",
                                   "#7b4fa3", "#56b4e9", "#8c6d46"};

// A logarithmic axis from `low` at pixel `from` to `high` at pixel `to`.
struct Axis {
  double low = 1, high = 10, from = 0, to = 1;

  double at(double value) const {
    return from + std::log(value / low) / std::log(high / low) * (to - from);
  }
  bool holds(double value) const { return value >= low && value <= high; }
};

Axis axis_around(double low, double high, double from, double to) {
  const double margin = std::max(1.35, std::pow(high / low, .06));
  return {low / margin, high * margin, from, to};
}

// 1, 2, 5 a decade, or whole decades where there are many.
std::vector<double> ticks_of(const Axis& axis) {
  const double decades = std::log10(axis.high / axis.low);
  std::vector<double> ticks;
  for (int k = -20; k <= 20; ++k)
    for (const double digit : {1., 2., 5.}) {
      const double value = digit * std::pow(10., k);
      if (axis.holds(value) && (digit == 1 || decades < 2.5)) ticks.push_back(value);
    }
  return ticks;
}

std::string tick_text(double value) {
  const int exponent = static_cast<int>(std::lround(std::floor(std::log10(value) + 1e-9)));
  if (exponent >= -4 && exponent <= 3) return significant(value, 1);
  const auto digit = static_cast<int>(std::lround(value / std::pow(10., exponent)));
  return (digit == 1 ? "1" : std::to_string(digit)) + "e" + std::to_string(exponent);
}

// Runs of one method through the sizes, and how they are drawn.
struct Curve {
  std::vector<const Run*> runs;
  SvgStroke stroke;
  int marker = 0;
  bool has_labels = false;  // the first of its elements
};

template <class T>
std::size_t position_in(std::vector<T>& known, const T& value) {
  const auto it = std::find(known.begin(), known.end(), value);
  if (it != known.end()) return static_cast<std::size_t>(it - known.begin());
  known.push_back(value);
  return known.size() - 1;
}

std::vector<Curve> curves_of(const Study& study) {
  std::vector<Curve> curves;
  std::vector<std::string> names, elements;
  std::vector<double> factors;
  for (const Run& run : study.runs) {
    if (!is_sound(run) || run.is_reference) continue;
    const std::size_t n_elements = elements.size();
    const std::size_t k = position_in(names, method_text(run));
    const std::size_t colour = position_in(elements, run.method);
    if (k == curves.size())
      curves.push_back({.stroke = {.colour = colours[colour % std::size(colours)],
                                   .width = 1.8,
                                   .dash = run.precision == "single" ? "5 4" : ""},
                        .marker = static_cast<int>(position_in(factors, run.step_factor)),
                        .has_labels = elements.size() > n_elements});
    curves[k].runs.push_back(&run);
  }
  return curves;
}

// What the vertical axis shows.
struct ErrorScale {
  std::string label;
  double unit = 1;  // relative error of 1 on the axis
};

ErrorScale error_scale(const Problem& problem) {
  if (problem.length == 0) return {"error of the " + problem.quantity + " [%]", .01};
  return {(problem.is_scene ? "greatest surface error" : "error of the " + problem.quantity) +
              std::string(" [mm]"),
          1e-3 / problem.length};
}

struct Panel {
  std::string x_label;
  std::function<double(const Run&)> x_of;
  double left = 0, right = 0;
  bool has_labels = false, has_real_time = false;
};

struct Axes {
  Axis x, y;
};

Axes axes_of(const Study& study, const std::vector<Curve>& curves, const Panel& panel) {
  const ErrorScale scale = error_scale(study.problem);
  double x_low = 1e300, x_high = 0, y_low = 1e300, y_high = 0;
  for (const Curve& curve : curves)
    for (const Run* run : curve.runs) {
      x_low = std::min(x_low, panel.x_of(*run));
      x_high = std::max(x_high, panel.x_of(*run));
      y_low = std::min(y_low, run->error / scale.unit);
      y_high = std::max(y_high, run->error / scale.unit);
    }
  return {axis_around(x_low, x_high, panel.left, panel.right),
          axis_around(y_low, y_high, panel_bottom, panel_top)};
}

std::string draw_grid(const Panel& panel, const Axes& axes, const std::string& y_label) {
  const SvgStroke faint{.colour = "#dddddd"};
  std::string svg;
  for (const double x : ticks_of(axes.x)) {
    const double at = axes.x.at(x);
    svg += svg_line({at, panel_top}, {at, panel_bottom}, faint);
    svg += svg_text({at, panel_bottom + 18}, {.text = tick_text(x), .anchor = SvgAnchor::middle});
  }
  for (const double y : ticks_of(axes.y)) {
    const double at = axes.y.at(y);
    svg += svg_line({panel.left, at}, {panel.right, at}, faint);
    svg += svg_text({panel.left - 8, at + 4}, {.text = tick_text(y), .anchor = SvgAnchor::end});
  }
  svg += svg_polyline(
      {{panel.left, panel_top}, {panel.left, panel_bottom}, {panel.right, panel_bottom}}, {});
  svg += svg_text({(panel.left + panel.right) / 2, panel_bottom + 40},
                  {.text = panel.x_label, .anchor = SvgAnchor::middle});
  return svg + svg_text({panel.left - 56, (panel_top + panel_bottom) / 2},
                        {.text = y_label, .anchor = SvgAnchor::middle, .is_upright = true});
}

std::string draw_limits(const Study& study, const Panel& panel, const Axes& axes) {
  std::string svg;
  const double own = study.problem.reference_error / error_scale(study.problem).unit;
  if (own > axes.y.low) {
    const double at = axes.y.at(std::min(own, axes.y.high));
    svg += svg_rectangle({panel.left, at}, {panel.right, panel_bottom}, "#eeeeee");
    svg += svg_text({panel.left + 6, panel_bottom - 6},
                    {.text = "reference's own error", .size = 11, .colour = "#666666"});
  }
  if (panel.has_real_time && axes.x.holds(1)) {
    const double at = axes.x.at(1);
    svg += svg_line({at, panel_top}, {at, panel_bottom}, {.colour = "#888888", .dash = "3 3"});
    svg +=
        svg_text({at + 5, panel_top + 11}, {.text = "real time", .size = 11, .colour = "#666666"});
  }
  return svg;
}

std::string point_title(const Study& study, const Run& run) {
  return case_text(run) + ": error " + percent_text(run.error) +
         (study.problem.length > 0 ? ", " + length_text(run.error_length) : "") + ", " +
         seconds_text(run.outcome.stepping_seconds) + ", h = " + length_text(run.outcome.h) +
         (run.outcome.dt > 0 ? ", dt = " + seconds_text(run.outcome.dt) : "");
}

// Filled points lie on the Pareto front.
std::string draw_curve(const Study& study, const Curve& curve, const Panel& panel,
                       const Axes& axes) {
  const double unit = error_scale(study.problem).unit;
  const std::vector<const Run*> front = pareto_front(study);
  std::vector<SvgPoint> points;
  for (const Run* run : curve.runs)
    points.push_back({axes.x.at(panel.x_of(*run)), axes.y.at(run->error / unit)});
  std::string svg = svg_polyline(points, curve.stroke);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Run* run = curve.runs[k];
    const bool is_best = std::find(front.begin(), front.end(), run) != front.end();
    svg +=
        svg_marker(points[k], curve.marker, curve.stroke.colour, is_best, point_title(study, *run));
    if (panel.has_labels && curve.has_labels)
      svg += svg_text({points[k].x + 7, points[k].y - 7},
                      {.text = run->size, .size = 11, .colour = curve.stroke.colour});
  }
  return svg;
}

std::string draw_panel(const Study& study, const std::vector<Curve>& curves, const Panel& panel) {
  const Axes axes = axes_of(study, curves, panel);
  std::string svg = draw_limits(study, panel, axes);
  svg += draw_grid(panel, axes, error_scale(study.problem).label);
  for (const Curve& curve : curves) svg += draw_curve(study, curve, panel, axes);
  return svg;
}

// Four labels of up to 31 letters of 6.6 units fit in a row; two, of longer ones.
std::size_t legend_columns(const std::vector<Curve>& curves) {
  const bool is_long = std::any_of(curves.begin(), curves.end(), [](const Curve& curve) {
    return method_text(*curve.runs.front()).size() > 31;
  });
  return is_long ? 2 : 4;
}

std::string draw_legend(const std::vector<Curve>& curves) {
  std::string svg;
  const std::size_t n_columns = legend_columns(curves);
  const double column = 1000.0 / static_cast<double>(n_columns);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const double x = 84 + column * static_cast<double>(k % n_columns);
    const double y = panel_bottom + 66 + legend_row * static_cast<double>(k / n_columns);
    svg += svg_polyline({{x, y}, {x + 34, y}}, curves[k].stroke);
    svg += svg_marker({x + 17, y}, curves[k].marker, curves[k].stroke.colour, false, "");
    svg += svg_text({x + 42, y + 4}, {.text = method_text(*curves[k].runs.front()), .size = 12});
  }
  return svg;
}

std::string subtitle(const Problem& problem) {
  const std::string own = problem.length > 0 ? length_text(problem.reference_error * problem.length)
                                             : percent_text(problem.reference_error);
  std::string text = problem.size_meaning.empty() ? "" : "n: " + problem.size_meaning + ". ";
  if (problem.is_scene) return text + "Reference: the finest run, own error about " + own + ".";
  text += "Reference: " + significant(problem.reference, 5) + " " + problem.unit + ", " +
          problem.source;
  return text + (problem.reference_error > 0 ? ", own error " + own + "." : ".");
}

}  // namespace

std::string study_svg(const Study& study) {
  const std::vector<Curve> curves = curves_of(study);
  const Problem& problem = study.problem;
  std::string svg = svg_text({84, 30}, {.text = problem.title, .size = 18, .is_bold = true});
  svg += svg_text({84, 53}, {.text = subtitle(problem), .size = 12, .colour = "#555555"});
  if (curves.empty()) {
    svg += svg_text({84, 120}, {.text = "No run can be rated."});
    return svg_document(width, 160, problem.title, svg);
  }
  svg += draw_panel(
      study, curves,
      {.x_label = problem.is_static() ? "processor time of one thread [s]"
                                      : "processor time a simulated second, one thread [s]",
       .x_of = [&](const Run& run) { return cost_of(study, run); },
       .left = 84,
       .right = 520,
       .has_labels = true,
       .has_real_time = !problem.is_static()});
  svg +=
      draw_panel(study, curves,
                 {.x_label = "element-steps", .x_of = element_steps, .left = 620, .right = 1056});
  const double rows =
      std::ceil(static_cast<double>(curves.size()) / static_cast<double>(legend_columns(curves)));
  const double height = panel_bottom + 86 + legend_row * rows;
  svg += draw_legend(curves);
  svg += svg_text({84, height - 14}, {.text = "Filled points: no other run is better in both error "
                                              "and processor time.",
                                      .size = 12,
                                      .colour = "#555555"});
  return svg_document(width, height, problem.title, svg);
}

}  // namespace trocar
