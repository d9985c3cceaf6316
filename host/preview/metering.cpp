#include "host/preview/metering.h"

#include <cmath>

#include "host/preview/view_transform.h"

namespace etendue {
namespace {

constexpr uint64_t enough_passes = 16;
constexpr double noticed = 0.5;  // powers of two: less than that is not worth a jump

}  // namespace

std::optional<double> Metering::look(const PreviewPicture& picture, double exposure) {
    if (metered_ && exposure != *metered_) stop();  // somebody has set it
    if (!is_on_ || picture.request.moving) return {};
    if (picture.algorithm != algorithm_) {  // which may find other light
        algorithm_ = picture.algorithm;
        step_ = UINT32_MAX;
    }
    const bool is_finer = picture.step < step_;
    if (!is_finer && (picture.step > step_ || picture.passes < next_ || next_ > enough_passes)) return {};
    step_ = picture.step;
    next_ = 2 * picture.passes;
    const double value = metered_exposure(picture.radiance);
    if (metered_ && std::abs(value - *metered_) < noticed) return {};
    metered_ = value;
    return value;
}

}  // namespace etendue
