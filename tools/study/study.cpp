#include "study/study.hpp"

#include <algorithm>
#include <filesystem>

namespace stillpoint::study {
namespace {

constexpr const char* kSeedOption = "runtime.seed=";

// Repeats differ by their seed, which the study counts.
void refuse_seed(OptionVisitor& v, const std::vector<std::string>& assignments) {
  v.require(std::ranges::none_of(
                assignments,
                [](const std::string& assignment) { return assignment.starts_with(kSeedOption); }),
            "'set' cannot change runtime.seed; write the study's 'seed' instead");
}

}  // namespace

void Sequence::visit(OptionVisitor& v) {
  v("name", name, {.help = "in tables and as the name of a folder", .required = true});
  v("dataset", dataset, {.help = "folder of a recording with ground truth", .is_path = true});
  v("scene", scene, {.help = "simulated once: a file, or a name from configs/scenes"});
  v("frames", frames, {.min = 0, .help = "frames of the scene; 0: as many as it says"});
  v("set", set, {.help = "changes of the scene, as in [source.seed=2]"});
  v("camera", camera,
    {.help = "a file, or a name from configs/cameras; empty: the recording's own"});
  v("empty_scene", empty_scene,
    {.help = "sequence that is the same without anything that moves; left out: NAME_empty"});
  v("original", original,
    {.help =
         "public recording that it is, or is the twin of; left out: the scene's name, or name"});
  v.require(dataset.empty() != scene.empty(),
            "needs either 'dataset', the folder of a recording, or 'scene', to be simulated");
  v.require(dataset.empty() || (frames == 0 && set.empty()),
            "'frames' and 'set' are for a 'scene'; they cannot change a recording");
}

void Variant::visit(OptionVisitor& v) {
  v("name", name, {.help = "in tables and as the name of a folder", .required = true});
  v("pipeline", pipeline, {.help = "a file, or a name from configs/pipelines", .required = true});
  v("set", set, {.help = "changes of the pipeline, as in [tracker.features=2000]"});
  v("only", only, {.help = "sequences to run on; none: all"});
  v("skip", skip, {.help = "sequences to leave out"});
  refuse_seed(v, set);
}

void Study::visit(OptionVisitor& v) {
  v("question", question, {.help = "that the study answers, in a line"});
  v("sequences", sequences, {.help = "recordings", .required = true});
  v("variants", variants, {.help = "pipelines and changes of them", .required = true});
  v("repeats", repeats, {.min = 1, .max = 1000, .help = "runs of each variant on each sequence"});
  v("seed", seed,
    {.min = 0, .max = 1e9, .help = "runtime.seed of the first repeat; the next has one more"});
  v("new_noise", new_noise,
    {.help = "simulate scenes anew for every repeat, with its seed as source.seed"});
  v("time_limit", time_limit,
    {.min = 0,
     .unit = "s",
     .help = "a run that takes longer is ended and has failed; 0: no limit"});
  v("pictures", pictures,
    {.min = 0,
     .max = 10,
     .help = "of the worst frames of each variant on each sequence, as in the paper's Fig. 5; the "
             "first repeat draws them, which takes time"});
  v.choice(
      "mode", mode,
      {{"pipeline", Mode::kPipeline}, {"inline", Mode::kInline}, {"threaded", Mode::kThreaded}},
      {.help = "runtime.mode of all; pipeline: as its file says"});
  v("set", set, {.help = "changes of every pipeline"});
  v("baseline", baseline, {.help = "variant that the others are compared with"});
  v("slurm", slurm, {.help = "what jobs of --executor slurm ask for"});
  v("published", published, {.help = "figures of others, shown beside"});
  refuse_seed(v, set);
}

std::string original_of(const Sequence& sequence) {
  if (!sequence.original.empty()) return sequence.original;
  return sequence.scene.empty() ? sequence.name
                                : std::filesystem::path(sequence.scene).stem().string();
}

std::vector<const Published*> published_with(const Study& study, std::size_t first,
                                             std::size_t end) {
  const auto has_any = [&](const Published& system) {
    for (const Sequence& sequence : study.sequences)
      for (std::size_t metric = first; metric < end; ++metric)
        if (system.find(original_of(sequence), static_cast<MetricId>(metric))) return true;
    return false;
  };
  std::vector<const Published*> systems;
  for (const Published& system : study.published)
    if (has_any(system)) systems.push_back(&system);
  return systems;
}

Sequence at_repeat(const Study& study, const Sequence& sequence, int repeat) {
  Sequence result = sequence;
  if (!study.new_noise || sequence.scene.empty()) return result;
  const std::string seed = std::to_string(study.seed + repeat);
  result.name += "-" + seed;
  result.set.push_back("source.seed=" + seed);
  return result;
}

bool same_images(const Sequence& a, const Sequence& b) {
  return a.dataset == b.dataset && a.scene == b.scene && a.frames == b.frames && a.set == b.set;
}

std::vector<std::string> assignments_of(const Study& study, const Variant& variant) {
  std::vector<std::string> assignments;
  if (study.mode == Study::Mode::kInline) assignments.emplace_back("runtime.mode=inline");
  if (study.mode == Study::Mode::kThreaded) assignments.emplace_back("runtime.mode=threaded");
  assignments.insert(assignments.end(), study.set.begin(), study.set.end());
  assignments.insert(assignments.end(), variant.set.begin(), variant.set.end());
  return assignments;
}

}  // namespace stillpoint::study
