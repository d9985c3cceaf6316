// When the exposure of a window is metered: with the first picture, which is coarse and may have met hardly
// any light, and again as pictures become better, until somebody else sets it.
#pragma once
#include <optional>

#include "host/preview/preview.h"

namespace etendue {

class Metering {
  public:
    void stop() { is_on_ = false; }
    // The exposure, in powers of two, that the picture should have; nothing where all stays as it is.
    // `exposure`: now.
    std::optional<double> look(const PreviewPicture& picture, double exposure);

  private:
    bool is_on_ = true;
    std::optional<double> metered_;
    Algorithm algorithm_ = Algorithm::automatic;
    uint32_t step_ = UINT32_MAX;  // of the picture that was looked at last
    uint64_t next_ = 0;           // passes of the next one of that step
};

}  // namespace etendue
