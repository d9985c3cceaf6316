// What sheets of microstructure read beside their records, for tests that bind the buffers of geometry
// themselves.
#pragma once
#include "host/scene/scene_compiler.h"
#include "tests/support/device_fixture.h"

namespace etendue {

class MicroProbe {
  public:
    // Of records that are filled for this probe; `scene` holds the cells, and must stay.
    RecordResolver resolver(const SceneDescription& scene) {
        RecordResolver result{scene, {}, {}, {}};
        result.places = [this](const std::filesystem::path& file, const ClassInfo& info,
                               const std::vector<std::byte>& record) {
            return read_micro_places(file, micro_sheet(info, record), 2, places_);
        };
        result.cell = [this, &scene](uint32_t i) {
            return append_cell_mesh(scene.cells[i].corners, 2, cells_);
        };
        return result;
    }
    // To be called when all records are filled.
    void bind(BufferTable& buffers) {
        const auto add = [&](const char* name, const auto& data) {
            buffers_.push_back(std::make_unique<Buffer>(create_buffer(test_device(), data, name)));
            buffers[name] = buffers_.back().get();
        };
        add("MicroCells", places_.cells), add("MicroPlaceRows", places_.places);
        add("CellNodes", cells_.nodes), add("CellTriangles", cells_.triangles);
    }
    const MicroTables& places() const { return places_; }

  private:
    MicroTables places_;
    CellTables cells_;
    std::vector<std::unique_ptr<Buffer>> buffers_;
};

}  // namespace etendue
