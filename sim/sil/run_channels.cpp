#include "sim/sil/run_channels.hpp"

#include <dds/ddsi/ddsi_serdata.h>

#include "hal/dds/idl/icd_hash.hpp"
#include "sim/sil/foxglove_messages.hpp"

namespace tumblesight::sim {

RunChannels::RunChannels(McapWriter& file) {
  each_topic([&](auto type, const char* name) {
    const hal::dds::Topic& topic = hal::dds::topic_of<typename decltype(type)::type>();
    const McapId schema =
        file.add_schema(std::string("tumblesight::icd::") + name, "omgidl", hal::dds::idl_text());
    of_bus[&topic] = file.add_channel(topic.name, "cdr", schema);
  });
  const auto show = [&](const char* topic, const FoxgloveSchema& schema) {
    return file.add_channel(topic, "json", file.add_schema(schema.name, "jsonschema", schema.text));
  };
  points = show(kPointCloudTopic, point_cloud_schema());
  transforms = show(kTransformsTopic, transforms_schema());
  log = show(kLogTopic, log_schema());
  figures = show(kFiguresTopic, figures_schema());
}

bool take_cdr(dds_entity_t reader, std::vector<std::uint8_t>& bytes) {
  for (;;) {
    ddsi_serdata* sample = nullptr;
    dds_sample_info_t info;
    if (dds_takecdr(reader, &sample, 1, &info, DDS_ANY_STATE) <= 0) return false;
    if (info.valid_data) {
      bytes.resize(ddsi_serdata_size(sample));
      ddsi_serdata_to_ser(sample, 0, bytes.size(), bytes.data());
    }
    ddsi_serdata_unref(sample);
    if (info.valid_data) return true;
  }
}

}  // namespace tumblesight::sim
