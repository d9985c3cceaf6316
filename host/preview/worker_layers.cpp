// What a picture holds besides radiance: errors, polarization, and what the pixels see first.
#include <algorithm>
#include <cmath>

#include "host/image/polarization.h"
#include "host/preview/worker.h"
#include "host/spectra/color.h"

namespace etendue {
namespace {

constexpr uint32_t aov_samples = 4;  // primary rays a pixel

std::vector<glm::vec3> read_colors(const Image& image, const std::vector<std::string>& channels) {
    std::vector<glm::vec3> result(pixel_count(image), glm::vec3(0));
    for (size_t c = 0; c < channels.size(); ++c) {
        const int channel = find_channel(image, channels[c]);
        if (channel < 0) return result;
        const auto values = plane(image, size_t(channel));
        for (size_t i = 0; i < result.size(); ++i) result[i][int(c)] = values[i];
    }
    return result;
}

// As in the relMSE (host/image/compare.h), of luminances.
std::vector<glm::vec3> relative_errors(const std::vector<glm::vec3>& radiance,
                                       const std::vector<glm::vec3>& errors) {
    std::vector<glm::vec3> result(radiance.size(), glm::vec3(0));
    double mean = 0;
    for (const glm::vec3& v : radiance) mean += luminance(glm::dvec3(v)) / double(radiance.size());
    for (size_t i = 0; i < errors.size(); ++i) {
        const double y = luminance(glm::dvec3(radiance[i])), error = luminance(glm::dvec3(errors[i]));
        result[i] = glm::vec3(float(error / std::sqrt(y * y + 0.01 * mean * mean + 1e-300)));
    }
    return result;
}

// Black where the film has no Stokes vectors.
std::vector<glm::vec3> polarization_colors(Layer layer, const PreviewPicture& picture) {
    std::vector<glm::vec3> result(picture.radiance.size(), glm::vec3(0));
    for (size_t i = 0; i < picture.stokes.size(); ++i) {
        const PolarizationState state = polarization_state(glm::dvec4(picture.stokes[i]));
        if (layer == Layer::linear) result[i] = degree_color(state.linear);
        if (layer == Layer::angle) result[i] = angle_color(state.angle) * std::min(4 * state.linear, 1.0f);
        if (layer == Layer::circular) result[i] = signed_degree_color(state.circular);
    }
    return result;
}

}  // namespace

// Developing errors takes longer than all else: only where the film has grown by half.
void PreviewWorker::look_at_errors(const PreviewRequest& request) {
    const bool wanted = request.wants_errors || request.layer == Layer::error;
    if (renderer_->passes() < next_errors_ && (!wanted || !errors_.empty() || renderer_->passes() < 2))
        return;
    next_errors_ = renderer_->passes() + renderer_->passes() / 2 + 1;
    status_.error = renderer_->relative_error();
    if (wanted) errors_ = read_colors(renderer_->develop(true), {"error.R", "error.G", "error.B"});
}

// Of the film at hand, for a picture of its size.
const Image& PreviewWorker::aovs(const PreviewPicture& picture) {
    if (aovs_.channels.empty()) {
        aovs_.width = picture.width, aovs_.height = picture.height;
        renderer_->add_aovs(aovs_, aov_samples);
    }
    return aovs_;
}

// Colours to show as they are; relative errors of the error layer.
std::vector<glm::vec3> PreviewWorker::develop_layer(Layer layer, const PreviewPicture& picture) {
    if (layer == Layer::error) return relative_errors(picture.radiance, errors_);
    if (layer == Layer::linear || layer == Layer::angle || layer == Layer::circular)
        return polarization_colors(layer, picture);
    if (layer == Layer::albedo) return read_colors(aovs(picture), {"albedo.R", "albedo.G", "albedo.B"});
    std::vector<glm::vec3> result;
    if (layer == Layer::normal) {
        result = read_colors(aovs(picture), {"normal.X", "normal.Y", "normal.Z"});
        for (glm::vec3& n : result) n = 0.5f * n + 0.5f;
        return result;
    }
    result = read_colors(aovs(picture), {"depth.Z"});
    float most = 1e-30f;
    for (const glm::vec3& d : result) most = std::max(most, d.x);
    for (glm::vec3& d : result) d = glm::vec3(d.x > 0 ? 1 - d.x / most : 0.0f);  // far is dark
    return result;
}

void PreviewWorker::publish(const PreviewRequest& request) {
    look_at_errors(request);
    auto picture = std::make_shared<PreviewPicture>();
    picture->width = (request.width + step_ - 1) / step_;
    picture->height = (request.height + step_ - 1) / step_;
    picture->step = step_;
    renderer_->read_picture(picture->radiance);
    picture->layer = request.layer;
    if (renderer_->is_stokes()) {
        const auto stokes = stokes_vectors(renderer_->develop(false));
        picture->stokes.assign(stokes.begin(), stokes.end());
    }
    if (request.layer != Layer::radiance) picture->shown = develop_layer(request.layer, *picture);
    picture->errors = errors_;
    if (request.wants_depth) {
        const Image& image = aovs(*picture);
        const auto depth = plane(image, size_t(find_channel(image, "depth.Z")));
        picture->depth.assign(depth.begin(), depth.end());
    }
    picture->passes = renderer_->passes();
    picture->algorithm = renderer_->choice().algorithm;
    picture->request = request;
    picture_ = std::move(picture);
}

}  // namespace etendue
