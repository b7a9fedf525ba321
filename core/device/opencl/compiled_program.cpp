#include "core/device/opencl/compiled_program.h"

#include <algorithm>
#include <mutex>
#include <vector>

namespace vat::opencl {

CompiledProgram::~CompiledProgram() {
  if (program_ != nullptr) api_.release_program(program_);
  if (context_ != nullptr) api_.release_context(context_);
}

Status CompiledProgram::build(const std::string& source, const std::string& options) {
  const auto failed = [&](const std::string& what) {
    return Error{"device_failed", "/device", device_.name + " (" + device_.driver + "): " + what};
  };
  cl_int code = CL_SUCCESS;
  context_ = api_.create_context(nullptr, 1, &device_.id, nullptr, nullptr, &code);
  if (code != CL_SUCCESS) return failed("no context, OpenCL error " + std::to_string(code));
  const char* text = source.c_str();
  program_ = api_.create_program(context_, 1, &text, nullptr, &code);
  if (code != CL_SUCCESS) return failed("no program, OpenCL error " + std::to_string(code));
  code = api_.build_program(program_, 1, &device_.id, options.c_str(), nullptr, nullptr);
  if (code == CL_SUCCESS) return {};
  std::size_t size = 0;
  api_.get_build_info(program_, device_.id, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
  std::string log(size, '\0');
  api_.get_build_info(program_, device_.id, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
  return failed("the kernels do not compile, OpenCL error " + std::to_string(code) + "\n" + log);
}

/// The programs of the process, in the order of their last use.
class CompiledPrograms {
 public:
  Result<std::shared_ptr<const CompiledProgram>> find(const Device& device,
                                                      const std::string& source,
                                                      const std::string& options) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find_if(programs_, [&](const Entry& entry) {
      return entry.device == device.id && entry.options == options && entry.source == source;
    });
    if (found != programs_.end()) {
      std::rotate(found, found + 1, programs_.end());
      return programs_.back().program;
    }
    const Result<const Api*> api = load_api();
    if (!api) return api.errors();
    const std::shared_ptr<CompiledProgram> program(new CompiledProgram(*api.value(), device));
    if (Status built = program->build(source, options); !built) return built.errors();
    if (programs_.size() == kKeptPrograms) programs_.erase(programs_.begin());
    programs_.push_back({device.id, source, options, program});
    return programs_.back().program;
  }

 private:
  struct Entry {
    cl_device_id device;
    std::string source;
    std::string options;
    std::shared_ptr<const CompiledProgram> program;
  };

  std::mutex mutex_;
  std::vector<Entry> programs_;
};

Result<std::shared_ptr<const CompiledProgram>> compile_once(const Device& device,
                                                            const std::string& source,
                                                            const std::string& options) {
  // Never destroyed: at the end of the process, the OpenCL library may be unusable.
  static CompiledPrograms& programs = *new CompiledPrograms;
  return programs.find(device, source, options);
}

}  // namespace vat::opencl
