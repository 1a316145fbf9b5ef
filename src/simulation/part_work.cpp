#include "wavetank/simulation/part_work.h"

#include "wavetank/scene/case_reader.h"
#include "wavetank/sph/parted_solver.h"

namespace wavetank {

parallel::Team::Work part_work(parallel::Group& member, int device_number, const ResourceResolver& resolve) {
  return work_of_part(member, [device_number, resolve](const std::string& scene_text) {
    Case scene = read_case_text(scene_text, "the case that the first rank has sent", {}, {resolve, {}});
    Layout layout = lay_out(scene, resolve);
    scene = settled(scene, layout);  // as it was, but for values of methods that it does not choose, which are not written
    const std::vector<compute::DeviceInfo> devices = compute::choose_devices(scene.device);
    const Discretisation discretisation = discretise(scene, layout);
    return PreparedPart{compute::Device(devices[static_cast<std::size_t>(device_number) % devices.size()]), std::move(scene),
                        std::move(layout), discretisation};
  });
}

}  // namespace wavetank
