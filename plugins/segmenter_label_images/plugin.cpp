#include "segmenter_label_images/label_image_segmenter.hpp"

STILLPOINT_PLUGIN(segmenter_label_images, "0.1.0",
                  stillpoint::provide<stillpoint::Segmenter,
                                      stillpoint::segmenter_label_images::LabelImageSegmenter>(
                      "label_images", "labels from disk, as they are or with a network's errors"));
