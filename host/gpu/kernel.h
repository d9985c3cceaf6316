// Compute kernels: pipelines whose bindings, push constants and workgroup size come from their SPIR-V, and
// lists of dispatches that are timed by kernel name.
#pragma once
#include <bit>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "host/gpu/buffer.h"
#include "host/gpu/reflection.h"
#include "host/gpu/texel_reads.h"

namespace etendue {

// Buffers by the names of the blocks that shaders see them through.
using BufferTable = std::map<std::string, const Buffer*>;

// The value of a push constant, by its name in the shader.
struct PushValue {
    PushValue(std::string name, uint32_t value) : name(std::move(name)), bits(value) {}
    PushValue(std::string name, int value) : name(std::move(name)), bits(uint32_t(value)) {}
    PushValue(std::string name, float value) : name(std::move(name)), bits(std::bit_cast<uint32_t>(value)) {}
    std::string name;
    uint32_t bits;
};

// Blocks of those buffers that are too large for a texel buffer of the device.
std::set<std::string> beyond_texels(const Device& device, const BufferTable& buffers);

// A pipeline without its buffers: what kernels of the same code share.
class Program {
  public:
    // Blocks named in `not_texels` are not read as texel buffers (host/gpu/texel_reads.h).
    Program(Device& device, const CompiledShader& shader, const std::set<std::string>& not_texels = {});
    Program(const Program&) = delete;
    ~Program();

    const std::string& name() const { return name_; }
    const ShaderLayout& layout() const { return layout_; }
    size_t spirv_bytes() const { return spirv_bytes_; }
    const std::filesystem::path& file() const { return file_; }  // CompiledShader::file

  private:
    friend class Kernel;
    friend class CommandList;
    bool has_texels(const std::string& block) const;  // is it read as a texel buffer?
    Device& device_;
    std::string name_;
    ShaderLayout layout_;
    size_t spirv_bytes_;
    std::filesystem::path file_;
    std::vector<TexelShader::View> texel_views_;
    std::vector<std::string> addressed_blocks_;  // whose addresses stand in the buffer at address_binding_
    uint32_t address_binding_ = 0;
    VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
    VkPipelineLayout pipeline_layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
};

// A program bound to its buffers, which must outlive it. Owns its Vulkan objects; movable.
class Kernel {
  public:
    Kernel() = default;
    // Fails with a clear line when `buffers` lacks one that the shader reads, or one is too large for a
    // binding.
    Kernel(Device& device, std::shared_ptr<const Program> program, const BufferTable& buffers);
    Kernel(Device& device, const CompiledShader& shader, const BufferTable& buffers)
        : Kernel(device, std::make_shared<const Program>(device, shader, beyond_texels(device, buffers)),
                 buffers) {}
    Kernel(Kernel&& other) noexcept { swap(other); }
    Kernel& operator=(Kernel&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Kernel();

    explicit operator bool() const { return program_ != nullptr; }
    const std::string& name() const { return program_->name(); }
    const ShaderLayout& layout() const { return program_->layout(); }
    uint32_t group_size() const {
        return layout().local_size[0] * layout().local_size[1] * layout().local_size[2];
    }

  private:
    friend class CommandList;
    void swap(Kernel& other) noexcept;
    void bind_texels(const TexelShader::View& view, const Buffer& buffer);
    Device* device_ = nullptr;
    std::shared_ptr<const Program> program_;
    Buffer addresses_;  // of the buffers that are read through them
    std::vector<VkBufferView> texel_views_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

// Groups of a dispatch that every device allows (Vulkan 1.3, table of required limits).
constexpr uint32_t max_groups = 65535;

struct KernelTiming {
    double seconds = 0;
    uint64_t dispatches = 0;
};
using KernelTimings = std::map<std::string, KernelTiming>;

// Dispatches in order, each seeing what the ones before it wrote. Usable again after run().
class CommandList {
  public:
    explicit CommandList(Device& device);
    CommandList(const CommandList&) = delete;
    ~CommandList();

    void dispatch(const Kernel& kernel, uint32_t groups, const std::vector<PushValue>& values = {});
    // Group counts are three words in `arguments` at `offset` bytes.
    void dispatch_indirect(const Kernel& kernel, const Buffer& arguments, uint64_t offset,
                           const std::vector<PushValue>& values = {});
    void fill(const Buffer& buffer, uint32_t word, uint64_t offset = 0, uint64_t bytes = VK_WHOLE_SIZE);
    // Submits, waits, and adds the time of each kernel to `timings` where one is given.
    void run(KernelTimings* timings = nullptr);

  private:
    void prepare(const Kernel& kernel, const std::vector<PushValue>& values);
    void begin();
    void barrier();
    void stamp(VkPipelineStageFlagBits stage);
    Device& device_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    VkQueryPool queries_ = VK_NULL_HANDLE;
    std::vector<std::string> timed_;  // kernel of each pair of time stamps
};

}  // namespace etendue
