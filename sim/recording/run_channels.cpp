#include "sim/recording/run_channels.hpp"

#include "hal/dds/idl/icd_hash.hpp"
#include "sim/recording/foxglove_messages.hpp"

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

}  // namespace tumblesight::sim
