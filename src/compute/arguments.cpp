#include "wavetank/compute/arguments.h"

#include "wavetank/common/error.h"

namespace wavetank::compute {

BoundKernel::BoundKernel(const Kernel& kernel, const Arguments& arguments) : kernel_(kernel) {
  for (const Parameter& parameter : kernel.parameters()) {
    const auto asks = [&] { return "the kernel " + kernel.name() + " asks for \"" + parameter.name + "\""; };
    const auto found = arguments.entries_.find(parameter.name);
    if (found == arguments.entries_.end()) throw Error(asks() + ", but nothing is called so where it is launched");
    const Arguments::Entry& entry = found->second;
    const auto alias = arguments.aliases_.find(parameter.type);
    const std::string& type = alias == arguments.aliases_.end() ? parameter.type : alias->second;
    if (entry.is_memory != parameter.is_memory)
      throw Error(asks() + " as " + (parameter.is_memory ? "an array, but it is a single value" : "a single value, but it is an array"));
    if (entry.type != type) throw Error(asks() + " as " + type + ", but it is " + entry.type);
    if (parameter.is_memory && entry.is_read_only && !parameter.is_const)
      throw Error(asks() + " to write to it, but there it may only be read");
    entries_.push_back(entry);
  }
}

void BoundKernel::launch(std::size_t items) const {
  unsigned index = 0;
  for (const Arguments::Entry& entry : entries_) {
    if (entry.is_memory)
      kernel_.set_memory(index, *entry.memory);
    else
      kernel_.set_bytes(index, entry.value, entry.size);
    ++index;
  }
  kernel_.enqueue(items, index);
}

}  // namespace wavetank::compute
