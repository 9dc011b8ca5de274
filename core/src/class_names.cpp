#include "stillpoint/class_names.hpp"

#include <algorithm>
#include <map>
#include <string_view>

#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

constexpr std::string_view kVoc =
    "background,aeroplane,bicycle,bird,boat,bottle,bus,car,cat,chair,cow,diningtable,dog,"
    "horse,motorbike,person,pottedplant,sheep,sofa,train,tvmonitor";
constexpr std::string_view kCoco =
    "background,person,bicycle,car,motorbike,aeroplane,bus,train,truck,boat,"
    "traffic light,fire hydrant,stop sign,parking meter,bench,bird,cat,dog,horse,sheep,"
    "cow,elephant,bear,zebra,giraffe,backpack,umbrella,handbag,tie,suitcase,frisbee,skis,"
    "snowboard,sports ball,kite,baseball bat,baseball glove,skateboard,surfboard,"
    "tennis racket,bottle,wine glass,cup,fork,knife,spoon,bowl,banana,apple,sandwich,"
    "orange,broccoli,carrot,hot dog,pizza,donut,cake,chair,sofa,pottedplant,bed,"
    "diningtable,toilet,tvmonitor,laptop,mouse,remote,keyboard,cell phone,microwave,oven,"
    "toaster,sink,refrigerator,book,clock,vase,scissors,teddy bear,hair drier,toothbrush";

ClassNames split(std::string_view names) {
  ClassNames result;
  for (std::size_t start = 0; start <= names.size();) {
    const std::size_t end = std::min(names.find(',', start), names.size());
    result.emplace_back(names.substr(start, end - start));
    start = end + 1;
  }
  return result;
}

const std::map<std::string, ClassNames>& lists() {
  static const std::map<std::string, ClassNames> kLists = {
      {"voc21", split(kVoc)}, {"coco80", split(kCoco)}, {"person", split("background,person")}};
  return kLists;
}

}  // namespace

ClassNames named_classes(const std::string& list) {
  const auto found = lists().find(list);
  if (found != lists().end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, classes] : lists()) names.push_back(name);
  throw Error(Fault::kUsage, "no class list named '" + list + "'" + did_you_mean(list, names) +
                                 "; there are: " + join(names));
}

ClassNames classes_of(const std::vector<std::string>& option) {
  constexpr std::size_t kMost = 256;  // labels are 8-bit
  ClassNames classes = option.size() == 1 ? named_classes(option.front()) : option;
  if (std::ranges::find(classes, "") != classes.end())
    throw Error(Fault::kUsage, "'classes' has a class without a name", "", "name it");
  if (classes.size() >= 2 && classes.size() <= kMost) return classes;
  throw Error(Fault::kUsage, "'classes' has " + std::to_string(classes.size()) + " names", "",
              "name a list (voc21, coco80, person), or the background and 1 to 255 classes");
}

int class_id(const ClassNames& classes, const std::string& name) {
  const auto found = std::ranges::find(classes, name);
  if (found != classes.end()) return static_cast<int>(found - classes.begin());
  throw Error(Fault::kUsage, "no class named '" + name + "'" + did_you_mean(name, classes) +
                                 (classes.empty() ? "; the segmenter has no classes"
                                                  : "; the segmenter has: " + join(classes)));
}

std::array<std::uint8_t, 3> color_of_class(std::uint8_t id) {
  std::array<std::uint8_t, 3> rgb{};
  for (unsigned bit = 0; bit < 8; ++bit)
    rgb[bit % 3] = static_cast<std::uint8_t>(rgb[bit % 3] | (id >> bit & 1U) << (7 - bit / 3));
  return rgb;
}

}  // namespace stillpoint
