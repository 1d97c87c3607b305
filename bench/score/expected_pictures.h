// The small pictures that `bench --score` compares images with, if no hash is known or the hash is another build's.
// Committed as JSON beside this file and compiled in.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bench/score/picture.h"
#include "bench/score/workload.h"

namespace wavecrest {

class ExpectedPictures {
 public:
  // Throws ScoreFileError if the file is for another version of the workload, or a picture in it is damaged.
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
