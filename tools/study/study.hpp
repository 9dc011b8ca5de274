// What a study file says: which sequences, which variants of the pipeline, how often.
#pragma once

#include <string>
#include <vector>

#include "stillpoint/options.hpp"
#include "study/published.hpp"
#include "study/slurm_options.hpp"

namespace stillpoint::study {

/// A recording with ground truth: one that lies on disk, or a scene to be simulated.
struct Sequence {
  std::string name;
  std::string dataset;           ///< folder; empty: simulated
  std::string scene;             ///< a file, or a name from configs/scenes
  int frames = 0;                ///< of the scene; 0: as many as it says
  std::vector<std::string> set;  ///< `key.sub=value` for the scene
  std::string camera;            ///< a file, or a name from configs/cameras; empty: the recording's
  std::string empty_scene;       ///< the sequence without anything that moves; empty: NAME_empty
  std::string original;          ///< see original_of

  void visit(OptionVisitor& visitor);
};

struct Variant {
  std::string name;
  std::string pipeline;           ///< a file, or a name from configs/pipelines
  std::vector<std::string> set;   ///< `key.sub=value`, stronger than those of the study
  std::vector<std::string> only;  ///< names of sequences; empty: all
  std::vector<std::string> skip;  ///< names of sequences

  void visit(OptionVisitor& visitor);
};

struct Study {
  enum class Mode { kPipeline, kInline, kThreaded };

  std::string question;  ///< that it answers, for lists and tables
  std::vector<Sequence> sequences;
  std::vector<Variant> variants;
  int repeats = 1;
  int seed = 1;             ///< repeat k runs with seed + k
  bool new_noise = false;   ///< scenes are simulated for each repeat
  double time_limit = 0.0;  ///< seconds, of a run; 0: none
  int pictures = 0;         ///< that the first repeat of each variant keeps of its worst frames
  Mode mode = Mode::kPipeline;
  std::vector<std::string> set;  ///< for all variants
  std::string baseline;          ///< name of a variant; empty: none
  SlurmOptions slurm;            ///< for jobs of a cluster
  std::vector<Published> published;

  void visit(OptionVisitor& visitor);
};

/// The public recording that the sequence is, or is the twin of, by which published figures are
/// found: `original`, or else the name of the scene, or else the sequence's own.
std::string original_of(const Sequence& sequence);

/// The systems of `published` that have one of the metrics [first, end) of one of the recordings.
std::vector<const Published*> published_with(const Study& study, std::size_t first,
                                             std::size_t end);

/// The sequence as a repeat runs on it: a scene with noise of its own has its own name and seed.
Sequence at_repeat(const Study& study, const Sequence& sequence, int repeat);

/// Whether both have the same images; names, cameras and what they are compared with may differ.
bool same_images(const Sequence& a, const Sequence& b);

/// What a run of the variant is told, without the seed; later ones win.
std::vector<std::string> assignments_of(const Study& study, const Variant& variant);

}  // namespace stillpoint::study
