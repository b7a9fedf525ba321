#include <oclgrind/Context.h>
#include <oclgrind/Kernel.h>
#include <oclgrind/KernelInvocation.h>
#include <oclgrind/Memory.h>
#include <oclgrind/Plugin.h>

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_set>

#include "llvm/IR/DerivedTypes.h"
#include "llvm/IR/Instructions.h"

/// A plugin of Oclgrind: counts operations and memory accesses of each kernel. At the end of the
/// process, it writes the table to the file that the variable VAT_KERNEL_COUNTS names.
namespace {

/// Unit of the traffic between the memories of a GPU [bytes].
constexpr std::size_t kSector = 32;

/// The work of all runs of a kernel.
struct Counts {
  std::uint64_t runs = 0;
  std::uint64_t items = 0;
  std::uint64_t single = 0;        ///< sums, products, divisions and roots in single precision
  std::uint64_t double_ = 0;       ///< the same in double precision
  std::uint64_t instructions = 0;  ///< all instructions, also the above
  std::uint64_t accessed = 0;      ///< bytes that work-items load and store
  std::uint64_t of_groups = 0;     ///< bytes of the sectors that each work-group accesses
  std::uint64_t distinct = 0;      ///< bytes of the sectors that each run accesses
};

class KernelCounter : public oclgrind::Plugin {
 public:
  explicit KernelCounter(const oclgrind::Context* context) : Plugin(context) {}

  ~KernelCounter() override {
    const char* path = std::getenv("VAT_KERNEL_COUNTS");
    if (path == nullptr) return;
    std::ofstream file(path);
    file << "kernel,runs,items,single,double,instructions,accessed,of_groups,distinct\n";
    for (const auto& [name, c] : counts_) {
      file << name << ',' << c.runs << ',' << c.items << ',' << c.single << ',' << c.double_ << ','
           << c.instructions << ',' << c.accessed << ',' << c.of_groups << ',' << c.distinct
           << '\n';
    }
  }

  bool isThreadSafe() const override { return false; }
  void kernelBegin(const oclgrind::KernelInvocation* run) override {
    now_ = &counts_[run->getKernel()->getName()];
    ++now_->runs;
    sectors_of_run_.clear();
  }
  void kernelEnd(const oclgrind::KernelInvocation*) override {
    now_->distinct += kSector * sectors_of_run_.size();
  }
  void workGroupBegin(const oclgrind::WorkGroup*) override { sectors_of_group_.clear(); }
  void workGroupComplete(const oclgrind::WorkGroup*) override {
    now_->of_groups += kSector * sectors_of_group_.size();
  }
  void workItemBegin(const oclgrind::WorkItem*) override { ++now_->items; }

  void instructionExecuted(const oclgrind::WorkItem*, const llvm::Instruction* instruction,
                           const oclgrind::TypedValue&) override {
    ++now_->instructions;
    const llvm::Type* type = instruction->getType();
    if (!type->isFPOrFPVectorTy()) return;
    const std::uint64_t operations = operations_of(*instruction);
    if (operations == 0) return;
    (type->getScalarType()->isDoubleTy() ? now_->double_ : now_->single) +=
        operations * length_of(type);
  }
  void memoryLoad(const oclgrind::Memory* memory, const oclgrind::WorkItem*, std::size_t address,
                  std::size_t size) override {
    access(memory, address, size);
  }
  void memoryStore(const oclgrind::Memory* memory, const oclgrind::WorkItem*, std::size_t address,
                   std::size_t size, const std::uint8_t*) override {
    access(memory, address, size);
  }
  void memoryAtomicLoad(const oclgrind::Memory* memory, const oclgrind::WorkItem*,
                        oclgrind::AtomicOp, std::size_t address, std::size_t size) override {
    access(memory, address, size);
  }
  void memoryAtomicStore(const oclgrind::Memory* memory, const oclgrind::WorkItem*,
                         oclgrind::AtomicOp, std::size_t address, std::size_t size) override {
    access(memory, address, size);
  }

 private:
  static std::uint64_t length_of(const llvm::Type* type) {
    const auto* vector = llvm::dyn_cast<llvm::FixedVectorType>(type);
    return vector == nullptr ? 1 : vector->getNumElements();
  }

  /// Operations per element of the result.
  static std::uint64_t operations_of(const llvm::Instruction& instruction) {
    switch (instruction.getOpcode()) {
      case llvm::Instruction::FAdd:
      case llvm::Instruction::FSub:
      case llvm::Instruction::FMul:
      case llvm::Instruction::FDiv:
        return 1;
      case llvm::Instruction::Call: {
        const llvm::Function* called = llvm::cast<llvm::CallInst>(instruction).getCalledFunction();
        if (called == nullptr) return 0;
        const llvm::StringRef name = called->getName();
        if (name.contains("sqrt")) return 1;
        return name.contains("fma") || name.contains("fmuladd") || name.contains("3mad") ? 2 : 0;
      }
      default:
        return 0;
    }
  }

  void access(const oclgrind::Memory* memory, std::size_t address, std::size_t size) {
    // A host's access is outside of kernels.
    if (now_ == nullptr || memory->getAddressSpace() != oclgrind::AddrSpaceGlobal) return;
    now_->accessed += size;
    for (std::size_t s = address / kSector; s <= (address + size - 1) / kSector; ++s) {
      if (sectors_of_group_.insert(s).second) sectors_of_run_.insert(s);
    }
  }

  std::map<std::string, Counts> counts_;
  Counts* now_ = nullptr;
  std::unordered_set<std::size_t> sectors_of_group_;
  std::unordered_set<std::size_t> sectors_of_run_;
};

}  // namespace

extern "C" {

void initializePlugins(oclgrind::Context* context) {
  // Destroyed at the end of the process, because the context of the program never is.
  static KernelCounter counter(context);
  context->registerPlugin(&counter);
}

void releasePlugins(oclgrind::Context*) {}
}
