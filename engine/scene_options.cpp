// Every key of a scene file, declared once.
#include "engine/scene.h"

namespace trocar {

const std::vector<std::pair<std::string, InstrumentKind>> instrument_kinds = {
    {"probe", InstrumentKind::probe},
    {"grasper", InstrumentKind::grasper},
    {"scalpel", InstrumentKind::scalpel},
    {"scissors", InstrumentKind::scissors}};

namespace {

constexpr Range unit_range{.low = 0, .high = 1};

Options<SceneTime> time_options() {
  Options<SceneTime> t("How long, how often, how fast.");
  t.number("duration", &SceneTime::duration, dim::time, positive,
           "Simulated time; to the nearest whole frame.", Need::required);
  t.number("frame_rate", &SceneTime::frame_rate, dim::rate, {.low = 1, .high = 10000},
           "Frames a second: contact detection, cuts and outputs happen once a frame. \"30 Hz\".");
  t.choice("pace", &SceneTime::pace, {{"fast", Pace::fast}, {"real-time", Pace::real_time}},
           "fast: as fast as the machine allows; real-time: each frame waits for its deadline.");
  t.choice("overrun", &SceneTime::overrun,
           {{"catch-up", Overrun::catch_up}, {"shift", Overrun::shift}, {"stop", Overrun::stop}},
           "After a missed deadline of pace = \"real-time\": catch-up: a late run goes on at once "
           "until it has caught up; shift: later deadlines move by the lateness, so that no frame "
           "is hurried; stop: the run ends with exit code 3, and what it had is kept.");
  return t;
}

template <class Look>
void add_colours(Options<Look>& look) {
  look.vector("colour", &Look::colour, dim::none, unit_range, "Outer surface, linear RGB.");
  look.vector("cut_colour", &Look::cut_colour, dim::none, unit_range, "Inside, where it was cut.");
}

Options<SceneRegionMaterial> region_material_options() {
  Options<SceneRegionMaterial> r("Another material for a region of the mesh; the last one counts.");
  r.text("region", &SceneRegionMaterial::region,
         "Region of elements of the mesh file, or of [[region]].", Need::required);
  r.table("material", &SceneRegionMaterial::material, material_options(), Need::required);
  Options<SceneRegionLook> look("How the region looks; a colour that is left out is the tissue's.");
  add_colours(look);
  r.table("look", &SceneRegionMaterial::look, look);
  return r;
}

Options<SceneShape> shape_options() {
  Options<SceneShape> s("A generated body, instead of a mesh file.");
  s.choice("kind", &SceneShape::kind,
           {{"box", ShapeKind::box},
            {"ball", ShapeKind::ball},
            {"cylinder", ShapeKind::cylinder},
            {"rectangle", ShapeKind::rectangle},
            {"triangular-rectangle", ShapeKind::triangular_rectangle}},
           "Sides are named \"x-\", \"x+\", \"y-\", … as regions.", Need::required);
  s.choice("elements", &SceneShape::elements,
           {{"hex8", BoxElements::hex8},
            {"tet4-kuhn", BoxElements::tet4_kuhn},
            {"tet4-five", BoxElements::tet4_five}},
           "Elements of box, ball and cylinder.");
  s.vector("low", &SceneShape::low, dim::length, any, "Lower corner of a box.");
  s.vector("high", &SceneShape::high, dim::length, any,
           "Upper corner of a box; a rectangle runs from 0 to here, but a triangular-rectangle "
           "only along "
           "x: its height follows from its rows of equilateral triangles.");
  s.vector("centre", &SceneShape::centre, dim::length, any,
           "Centre of a ball, of a cylinder's base.");
  s.number("radius", &SceneShape::radius, dim::length, positive, "Of ball and cylinder.");
  s.number("height", &SceneShape::height, dim::length, positive, "Of a cylinder.");
  s.integers("cells", &SceneShape::cells, {.low = 1, .high = 2000},
             "Cells in x, y, z; nodes in x and y for a rectangle.");
  return s;
}

Options<SceneLook> look_options() {
  Options<SceneLook> l("How the tissue looks.");
  add_colours(l);
  l.number("wetness", &SceneLook::wetness, dim::none, unit_range, "0 dry … 1 wet.");
  l.number("texture_size", &SceneLook::texture_size, dim::length, positive,
           "Of the surface pattern.");
  l.boolean("has_edges", &SceneLook::has_edges, "Draw element edges.");
  return l;
}

Options<SceneTissue> tissue_options() {
  Options<SceneTissue> t("The body that is operated on.");
  t.text("mesh", &SceneTissue::mesh, "Mesh file (.msh, .vtk, .vtu), relative to the scene file.");
  t.number("scale", &SceneTissue::scale, dim::length, positive,
           "Length of one unit of the mesh file, \"1 mm\" for a mesh in millimetres.");
  t.boolean("renumber", &SceneTissue::is_renumbered,
            "Numbers nodes and elements of a mesh file anew where that brings an element's nodes "
            "closer together in memory, so that steps are faster; messages and recordings count in "
            "the new order. false: the order of the file.");
  t.number("longest_side", &SceneTissue::longest_side, dim::length, not_negative,
           "Scales the mesh so that the longest side of its bounding box has this length; 0: not.");
  t.boolean("centred", &SceneTissue::is_centred,
            "Moves the centre of the bounding box to the origin.");
  t.vector("translate", &SceneTissue::translate, dim::length, any, "Added to all positions, last.");
  t.table("shape", &SceneTissue::shape, shape_options());
  t.table("material", &SceneTissue::material, material_options());
  t.list("region_material", &SceneTissue::region_materials, region_material_options());
  t.number("thickness", &SceneTissue::thickness, dim::length, positive, "Of a plane (2D) body.");
  t.table("look", &SceneTissue::look, look_options());
  return t;
}

Options<SceneSolver> solver_options() {
  Options<SceneSolver> s("How the mechanics are computed.");
  s.vector("gravity", &SceneSolver::gravity, dim::acceleration, any, "Acceleration of gravity.");
  s.number("mass_damping", &SceneSolver::mass_damping, dim::rate, not_negative,
           "alpha of C = alpha M.");
  s.number("hourglass", &SceneSolver::hourglass, dim::none, {.low = 0, .high = 1},
           "Hourglass stiffness of one-point hexahedra, as a share of mu.");
  s.choice(
      "hexahedron", &SceneSolver::hexahedron,
      {{"one-point", Formulation::hex8_one_point},
       {"enhanced", Formulation::hex8_enhanced},
       {"full", Formulation::hex8_full}},
      "one-point: with hourglass stiffness; enhanced: hourglass energy of the material's shear "
      "modulus, without a free constant; full: eight points, locks when nu is near 0.5.");
  s.choice("tetrahedron", &SceneSolver::tetrahedron,
           {{"linear", Formulation::tet4}, {"nodal-pressure", Formulation::tet4_nodal_pressure}},
           "linear: locks when nu is near 0.5; nodal-pressure: averages the pressure at nodes, of "
           "materials whose volumetric energy stands apart (not linear, not st-venant-kirchhoff).");
  s.choice("triangle", &SceneSolver::triangle,
           {{"plane-strain", Formulation::tri3_plane_strain},
            {"plane-stress", Formulation::tri3_plane_stress}},
           "plane-strain: the thickness is held; plane-stress: it is free.");
  s.choice("precision", &SceneSolver::precision,
           {{"double", Precision::in_double}, {"single", Precision::in_single}},
           "Numbers that elements compute with; positions and velocities are double.");
  s.number("step_factor", &SceneSolver::step_factor, dim::none,
           {.low = 0, .high = 1, .is_low_open = true},
           "Time step / computed stable step; from 0.866 on the scheme has a resonance. 0.85 if "
           "absent, of bodies in plane stress 0.7.");
  s.choice(
      "stable_step", &SceneSolver::stable_step,
      {{"element-bound", StableStep::element_bound}, {"frequency", StableStep::frequency}},
      "From the body's highest frequency, less 2 %, as it grows with the deformation, or from "
      "bounds of "
      "each element, which need no search and are 1.4 to 3.3 times smaller, more with slivers.");
  s.number("mass_scaling_step", &SceneSolver::mass_scaling_step, dim::time, not_negative,
           "Selective mass scaling: undeformed elements whose own bound on the step is below this "
           "get inertia against deformation and rotation, not against translation, until they "
           "reach it. 0: none.");
  s.number("sleep", &SceneSolver::sleep, dim::length, not_negative,
           "Largest error of displacements that may come from leaving out what is at rest: who "
           "stays within a sixteenth of it for half a second, or for the time in which the slowest "
           "motion of the body turns back or dies down, sleeps until its surroundings move or are "
           "touched, or what acts on the body changes. Not for viscoelastic tissue. 0: nothing "
           "sleeps.");
  s.boolean("multirate", &SceneSolver::is_multirate,
            "Small elements take substeps of their own where that saves work, so that they don't "
            "set everyone's step while nothing touches them. Needs stable_step = \"frequency\"; "
            "not for viscoelastic tissue, "
            "nodal-pressure or mass_scaling_step.");
  return s;
}

Options<SceneContact> contact_options() {
  Options<SceneContact> c("Contact between instruments and tissue, and of tissue with itself.");
  c.number("friction", &SceneContact::friction, dim::none, not_negative, "Coulomb's coefficient.");
  c.number(
      "release_speed", &SceneContact::release_speed, dim::velocity, not_negative,
      "Speed at which tissue leaves an instrument that appears inside of it, as jaws that open "
      "do.");
  c.boolean("tissue", &SceneContact::has_tissue,
            "Tissue touches tissue: the lips of a wound, folds, pieces that were cut off. Bodies "
            "only, and not with solver.sleep.");
  return c;
}

Options<SceneCutting> cutting_options() {
  Options<SceneCutting> c("How blades cut.");
  c.number("advance", &SceneCutting::advance, dim::none, {.low = 0.1, .high = 5},
           "Edge lengths that the blade sweeps before the mesh is changed; plane cuts advance by "
           "three, whatever this says.");
  c.number("least_step_ratio", &SceneCutting::least_step_ratio, dim::none, {.low = 0.05, .high = 1},
           "Floor on stable step after / before a cut: of the tetrahedra around it, 0.75 if "
           "absent; of a "
           "plane body before it was cut at all, 0.5 if absent. Not in mode paper.");
  c.number("split_step_ratio", &SceneCutting::split_step_ratio, dim::none, {.low = 0, .high = 1},
           "Tetrahedra where tissue is one element thick: edges may get new nodes that part it, as "
           "long as no element's step bound sinks below this part of the body's least one by that. "
           "Above 0.5 parts of many elements can't keep it, and more stays joined than with 0. "
           "0: cuts add no nodes but copies, as in bodies that have or had hexahedra.");
  c.number(
      "resistance", &SceneCutting::resistance, {.kilogram = 1, .second = -2}, not_negative,
      "Work of a cut over its area: the tissue's largest force against a blade per length of the "
      "edge at tissue that it parts, \"20 N/m\". None in a slit that is cut already.");
  c.choice("mode", &SceneCutting::mode, {{"robust", CutMode::robust}, {"paper", CutMode::paper}},
           "Plane cuts: robust (flips, sliding) or as published by Serby, Harders and Szekely.");
  c.number("spring", &SceneCutting::spring, dim::none, not_negative,
           "Plane cuts: s_spring of the paper's eq. 6.");
  c.number("particle", &SceneCutting::particle, dim::none, not_negative, "Plane cuts: s_particle.");
  return c;
}

Options<SceneStart> start_options() {
  Options<SceneStart> s("The body before the first frame.");
  s.choice("state", &SceneStart::state,
           {{"undeformed", StartState::undeformed}, {"equilibrium", StartState::equilibrium}},
           "undeformed: as in the mesh, so that gravity sets it swinging; equilibrium: at rest "
           "under gravity, supports and loads as they are at time 0, found by dynamic relaxation "
           "without instruments; "
           "viscoelastic material has relaxed (long-term moduli, no overstress).");
  s.number("tolerance", &SceneStart::tolerance, dim::none,
           {.low = 1e-12, .high = 0.01, .is_low_open = true},
           "Forces out of balance / forces of supports that count as equilibrium; 3e-5 or more in "
           "single precision.");
  s.integer("max_iterations", &SceneStart::max_iterations, {.low = 1, .high = 100000000},
            "The run ends with trouble if these are not enough.");
  return s;
}

Options<SceneCheckpoint> checkpoint_options() {
  Options<SceneCheckpoint> c("What \"trocar run --resume\" continues from.");
  c.number(
      "every", &SceneCheckpoint::every, dim::time, not_negative,
      "Interval of simulated time at which checkpoint.bin is replaced; also when a run stops or "
      "ends. 0: no checkpoints.");
  return c;
}

Options<SceneRegion> region_options() {
  Options<SceneRegion> r(
      "A named part of the body in its first position: its nodes and, for another material, the "
      "elements whose middle lies in it.");
  r.text("name", &SceneRegion::name, "Name for supports, loads and materials.", Need::required);
  r.choice("shape", &SceneRegion::shape,
           {{"box", RegionShape::box}, {"ellipsoid", RegionShape::ellipsoid}},
           "ellipsoid: the one that fills the box.");
  r.vector("low", &SceneRegion::low, dim::length, any, "Lower corner of the box.", Need::required);
  r.vector("high", &SceneRegion::high, dim::length, any, "Upper corner.", Need::required);
  return r;
}

Options<SceneSupport> support_options() {
  Options<SupportKey> key("Where the region is at a time.");
  key.number("time", &SupportKey::time, dim::time, not_negative, "When.", Need::required);
  key.vector("displacement", &SupportKey::displacement, dim::length, any,
             "From the first position.", Need::required);
  key.boolean("stop", &SupportKey::stops, "As of an instrument's keys.");
  Options<SceneSupport> s(
      "Holds or moves a region. Instruments pass through what is held in all components.");
  s.text("region", &SceneSupport::region,
         "Region of the mesh, of its surface or of its volumes, or of [[region]].", Need::required);
  s.text("fix", &SceneSupport::fix, "Which components: some of \"xyz\".");
  s.list("path", &SceneSupport::path, key,
         "Prescribed motion (needs fix = \"xyz\"), smooth like an instrument's.");
  return s;
}

Options<SceneLoad> load_options() {
  Options<LoadKey> key("How much of the load acts at a time.");
  key.number("time", &LoadKey::time, dim::time, not_negative, "When.", Need::required);
  key.number("factor", &LoadKey::factor, dim::none, any, "Of force and pressure.", Need::required);
  Options<SceneLoad> l("Pushes or pulls a region.");
  l.text("region", &SceneLoad::region,
         "Region of the mesh, of its surface or of its volumes, or of [[region]].", Need::required);
  l.vector("force", &SceneLoad::force, dim::force, any,
           "Of the whole region, in a fixed direction; spread over the faces of the surface that "
           "lie in the region, or evenly over its nodes where there are none.");
  l.number("pressure", &SceneLoad::pressure, dim::pressure, any,
           "On these faces from outside, always straight; wounds in them are left out.");
  l.list("path", &SceneLoad::path, key,
         "Factor over time, a smooth curve through the keys without overshoot, constant before and "
         "after; 1 if absent.");
  return l;
}

Options<SceneInstrument> instrument_options() {
  Options<InstrumentKey> key(
      "Where the instrument is at a time; smooth in between, at rest before and after.");
  key.number("time", &InstrumentKey::time, dim::time, not_negative, "When.", Need::required);
  key.vector("position", &InstrumentKey::position, dim::length, any, "Of the tip.", Need::required);
  key.vector("direction", &InstrumentKey::direction, dim::none, any, "From handle to tip.");
  key.vector("forward", &InstrumentKey::forward, dim::none, any,
             "Where the cutting edge faces; jaws open along it and against it. A scalpel cuts "
             "whichever way "
             "it moves; one that goes more than 60 degrees aside of it is told of.");
  key.boolean("stop", &InstrumentKey::stops,
              "Rest at this key, as at the first and the last: between two such keys the way is a "
              "straight line.");
  key.choice(
      "action", &InstrumentKey::action,
      {{"none", GraspAction::none}, {"close", GraspAction::close}, {"open", GraspAction::open}},
      "Of a grasper or scissors: they move for 0.2 s and have closed or opened at this time.");
  Options<SceneInstrument> i("A probe, grasper, scalpel or scissors on a path.");
  i.choice("kind", &SceneInstrument::kind, instrument_kinds,
           "Scissors cut what is between their blades when they close.", Need::required);
  i.text("name", &SceneInstrument::name, "Name in the metrics; the kind if absent.");
  i.number("radius", &SceneInstrument::radius, dim::length, positive, "Of the tip and shaft.");
  i.number(
      "length", &SceneInstrument::length, dim::length, positive,
      "From the tip to the end of the shaft; at least 4 radius behind a grasper's jaws of 22 mm "
      "or scissors' blades, and twice a scalpel's blade_length.");
  i.number("blade_length", &SceneInstrument::blade_length, dim::length, positive,
           "Of a scalpel's straight edge, from the tip up, behind which the blade is 0.28 times as "
           "wide, and 0.1 mm thick: along a narrow curve a long one presses the lips apart; of "
           "scissors, from tip to "
           "pivot: open, "
           "each stands 0.3 rad off the shaft, and what lies beside them is not cut.");
  i.number("grip_radius", &SceneInstrument::grip_radius, dim::length, positive,
           "A closing grasper holds the nodes within.");
  i.number("grip_force", &SceneInstrument::grip_force, dim::force, not_negative,
           "Tissue that pulls at a grasper with more, in the mean of a frame, slips out of its "
           "jaws, all at once. 0: they hold whatever pulls.");
  i.text("mesh", &SceneInstrument::mesh,
         "Surface (.stl, .obj) of the tip instead of the built-in shape; its origin is the tip, "
         "its +z the shaft, which stays (`length`). Tissue feels its convex hull, of a flat one as "
         "of a plate of 0.05 mm; of a scalpel, whose edge stays on the z axis and looks along +x, "
         "its flat sides; of open scissors the built-in blades.");
  i.number("scale", &SceneInstrument::scale, dim::length, positive,
           "Length of one unit of that file.");
  i.list("path", &SceneInstrument::path, key,
         "Key positions. The way through them is smooth and goes forwards along each leg; where it "
         "turns by 90 degrees or more it stops, and legs between such turns are straight. At "
         "smaller turns legs bulge, by up to 8 % of their length, to the side that the way does "
         "not turn to: for a straight cut at a constant depth, stop at both of its keys. The "
         "orientation goes the short way round from key to key, by the same rule: where its axis "
         "turns by 90 degrees or more, and beside a key of the same orientation, it stops.",
         Need::required);
  return i;
}

Options<SceneMarker> marker_options() {
  Options<SceneMarker> m("A point of the tissue that the metrics follow.");
  m.text("name", &SceneMarker::name, "Name in the metrics.", Need::required);
  m.vector("position", &SceneMarker::position, dim::length, any,
           "In the undeformed body, where the scene places it.", Need::required);
  return m;
}

Options<SceneCamera> camera_options() {
  Options<SceneCamera> c("A view.");
  c.text("name", &SceneCamera::name, "Name for outputs.");
  c.vector("eye", &SceneCamera::eye, dim::length, any, "Position of the lens and its light.",
           Need::required);
  c.vector("target", &SceneCamera::target, dim::length, any, "Point looked at.", Need::required);
  c.vector("up", &SceneCamera::up, dim::none, any, "Upward.");
  c.number("field_of_view", &SceneCamera::field_of_view, dim::angle, {.low = 0.02, .high = 2.6},
           "Vertical angle, \"50 deg\".");
  c.boolean("endoscope_mask", &SceneCamera::has_endoscope_mask,
            "Round picture, as through an endoscope.");
  return c;
}

Options<SceneOutput> output_options() {
  Options<SceneOutput> o("Something that is written while the scene runs.");
  o.choice("kind", &SceneOutput::kind,
           {{"video", OutputKind::video},
            {"frames", OutputKind::frames},
            {"recording", OutputKind::recording},
            {"metrics", OutputKind::metrics},
            {"contact-sheet", OutputKind::contact_sheet}},
           "video: mp4; frames: PNG files; recording: replayable database; metrics: CSV; "
           "contact-sheet: one PNG of nine moments.",
           Need::required);
  o.text("file", &SceneOutput::file, "Name inside the output folder; frames: a folder.",
         Need::required);
  o.text("camera", &SceneOutput::camera, "Name of a [[camera]]; the first if absent.");
  o.integers("size", &SceneOutput::size, {.low = 16, .high = 8192}, "Pixels: width, height.");
  o.number("every", &SceneOutput::every, dim::time, not_negative,
           "Interval, to the nearest whole number of frames; every frame if absent.");
  return o;
}

}  // namespace

Options<Scene> scene_options() {
  Options<Scene> s(
      "A Trocar scene: numbers are SI or texts with a unit (\"3 kPa\", \"2 mm\", \"30 deg\").");
  s.text("name", &Scene::name, "Title.");
  s.table("time", &Scene::time, time_options(), Need::required);
  s.table("tissue", &Scene::tissue, tissue_options(), Need::required);
  s.table("solver", &Scene::solver, solver_options());
  s.table("contact", &Scene::contact, contact_options());
  s.table("cutting", &Scene::cutting, cutting_options());
  s.table("start", &Scene::start, start_options());
  s.table("checkpoint", &Scene::checkpoint, checkpoint_options());
  s.list("region", &Scene::regions, region_options());
  s.list("support", &Scene::supports, support_options());
  s.list("load", &Scene::loads, load_options());
  s.list("instrument", &Scene::instruments, instrument_options());
  s.list("marker", &Scene::markers, marker_options());
  s.list("camera", &Scene::cameras, camera_options());
  s.list("output", &Scene::outputs, output_options());
  return s;
}

}  // namespace trocar
