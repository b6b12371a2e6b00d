#include "sim/recording/run_writer.hpp"

#include "hal/dds/idl/icd_hash.hpp"
#include "sim/recording/each_topic.hpp"

namespace tumblesight::sim {

RunWriter::RunWriter(const std::string& path) : file_(path, "tumblesight") {
  each_topic([&](auto type, const char* name) {
    const hal::dds::Topic& topic = hal::dds::topic_of<typename decltype(type)::type>();
    const McapId schema =
        file_.add_schema(std::string("tumblesight::icd::") + name, "omgidl", hal::dds::idl_text());
    of_bus_[&topic] = file_.add_channel(topic.name, "cdr", schema);
  });
  for (const View view : kViews) {
    const ShownChannel& channel = shown_channel(view);
    const McapId schema = file_.add_schema(channel.schema_name, "jsonschema", channel.schema);
    of_views_.at(static_cast<std::size_t>(view)) = file_.add_channel(channel.topic, "json", schema);
  }
}

void RunWriter::write(const hal::dds::Topic& topic, std::int64_t time_ns,
                      const std::vector<std::uint8_t>& bytes) {
  file_.write(of_bus_.at(&topic), time_ns, bytes.data(), bytes.size());
}

void RunWriter::write(View view, std::int64_t time_ns, std::string_view json) {
  file_.write(of_views_.at(static_cast<std::size_t>(view)), time_ns, json);
}

void RunWriter::write(const ShownStep& step, const ShownTime& time) {
  for (const View view : {View::kPoints, View::kTransforms, View::kFigures, View::kLog})
    for (const std::string& json : messages_of(step, time, view)) write(view, time(step.time_ns), json);
}

}  // namespace tumblesight::sim
