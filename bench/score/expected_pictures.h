// What `bench --score` compares an image with where no hash is known for it, or one of another build: a small picture
// of it, as text in a JSON file that is committed beside this one and compiled in.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/score/picture.h"
#include "bench/score/workload.h"

namespace wavecrest {

class ExpectedPictures {
 public:
  // Throws ScoreFileError for other versions of the workload, and for what is no picture.
  static ExpectedPictures parse(const nlohmann::json& file);
  static ExpectedPictures committed();  // bench/score/image_pictures.json
  nlohmann::ordered_json toJson() const;

  // Null where none is kept.
  const ScorePicture* find(ScoreSize size, const ScoreEntry& entry) const;
  void set(ScoreSize size, const ScoreEntry& entry, ScorePicture picture);

 private:
  std::map<std::string, ScorePicture> pictures_;  // by SIZE/SCENE/METHOD
};

}  // namespace wavecrest
