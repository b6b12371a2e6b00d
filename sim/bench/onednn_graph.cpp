#include "sim/bench/onednn_graph.hpp"

#include <omp.h>

namespace tumblesight::sim {
namespace {

using dnnl::inner_product_forward;
using dnnl::memory;
using Tag = memory::format_tag;
using Type = memory::data_type;

constexpr auto kInference = dnnl::prop_kind::forward_inference;
constexpr int kPerOutputChannel = 1 << 1;

memory::dims image_dims(int side, int channels) {
  return {1, channels, side, side};
}

dnnl::primitive_attr scaled(const Int8Layer& layer) {
  dnnl::primitive_attr attributes;
  attributes.set_output_scales(kPerOutputChannel, layer.scale);
  return attributes;
}

}  // namespace

OnednnGraph::OnednnGraph() {
  omp_set_num_threads(1);
}

memory OnednnGraph::image(int side, int channels) {
  return {{image_dims(side, channels), Type::u8, Tag::nhwc}, engine_};
}

memory OnednnGraph::vector(int values) {
  return {{{1, values}, Type::f32, Tag::nc}, engine_};
}

memory OnednnGraph::in_format(const memory& in, const memory::desc& format) {
  if (in.get_desc() == format) return in;
  memory out(format, engine_);
  step(dnnl::reorder(in, out), {{DNNL_ARG_FROM, in}, {DNNL_ARG_TO, out}});
  return out;
}

// Copied in any case, so that the caller's numbers are not needed later.
memory OnednnGraph::weights_in_format(const void* data, const memory::desc& ours,
                                      const memory::desc& format) {
  memory from(ours, engine_, const_cast<void*>(data)), to(format, engine_);
  dnnl::reorder(from, to).execute(stream_, from, to);
  stream_.wait();
  return to;
}

memory OnednnGraph::convolution(const Int8Layer& layer, const memory& in) {
  const gnc::LayerRow& row = layer.row;
  const memory::dims weight_dims{row.outputs, row.inputs, 3, 3}, one{1, 1};
  const memory::desc bias_desc({row.outputs}, Type::s32, Tag::x);
  const dnnl::convolution_forward::desc description(
      kInference, dnnl::algorithm::convolution_direct,
      memory::desc(image_dims(row.side, row.inputs), Type::u8, Tag::any),
      memory::desc(weight_dims, Type::s8, Tag::any), bias_desc,
      memory::desc(image_dims(row.side, row.outputs), Type::u8, Tag::any), one, one, one);
  const dnnl::convolution_forward::primitive_desc primitive(description, scaled(layer), engine_);
  const memory out(primitive.dst_desc(), engine_);
  step(dnnl::convolution_forward(primitive),
       {{DNNL_ARG_SRC, in_format(in, primitive.src_desc())},
        {DNNL_ARG_WEIGHTS, weights_in_format(layer.weight.data(), {weight_dims, Type::s8, Tag::hwio},
                                             primitive.weights_desc())},
        {DNNL_ARG_BIAS, weights_in_format(layer.bias.data(), bias_desc, primitive.bias_desc())},
        {DNNL_ARG_DST, out}});
  return pooled(row, out);
}

memory OnednnGraph::pooled(const gnc::LayerRow& row, const memory& in) {
  const memory::dims two{2, 2}, none{0, 0};
  const auto algorithm = row.output == gnc::LayerOutput::kMaxPooled
                             ? dnnl::algorithm::pooling_max
                             : dnnl::algorithm::pooling_avg_exclude_padding;
  const dnnl::pooling_forward::desc description(
      kInference, algorithm, in.get_desc(),
      memory::desc(image_dims(row.side / 2, row.outputs), Type::u8, Tag::any), two, two, none, none);
  const dnnl::pooling_forward::primitive_desc primitive(description, engine_);
  memory out(primitive.dst_desc(), engine_);
  step(dnnl::pooling_forward(primitive), {{DNNL_ARG_SRC, in}, {DNNL_ARG_DST, out}});
  return out;
}

// Behind an image the input is read as one vector, pixel by pixel as in flight: for an image oneDNN takes a
// slower product.
memory OnednnGraph::dense(const Int8Layer& layer, const memory& before) {
  const gnc::LayerRow& row = layer.row;
  const memory::dims in_dims{1, row.inputs}, weight_dims{row.outputs, row.inputs};
  const memory pixels = readable(before);
  const memory in({in_dims, Type::u8, Tag::nc}, engine_, pixels.get_data_handle());
  kept_.push_back(pixels);
  const memory::desc bias_desc({row.outputs}, Type::s32, Tag::x);
  const inner_product_forward::desc description(
      kInference, in.get_desc(), memory::desc(weight_dims, Type::s8, Tag::any), bias_desc,
      memory::desc({1, row.outputs}, is_hidden(row) ? Type::u8 : Type::f32, Tag::any));
  const inner_product_forward::primitive_desc primitive(description, scaled(layer), engine_);
  memory out(primitive.dst_desc(), engine_);
  step(inner_product_forward(primitive),
       {{DNNL_ARG_SRC, in},
        {DNNL_ARG_WEIGHTS,
         weights_in_format(layer.weight.data(), {weight_dims, Type::s8, Tag::io}, primitive.weights_desc())},
        {DNNL_ARG_BIAS, weights_in_format(layer.bias.data(), bias_desc, primitive.bias_desc())},
        {DNNL_ARG_DST, out}});
  return out;
}

memory OnednnGraph::dense(const Float32Layer& layer, const memory& in) {
  return product(layer.weight, &layer.bias, is_hidden(layer.row), in, nullptr);
}

memory OnednnGraph::gates(const Float32Layer& layer, const memory& in, const memory& hidden) {
  const memory from_input = product(layer.weight, &layer.bias, false, in, nullptr);
  return product(layer.recurrent, nullptr, false, hidden, &from_input);
}

// In float32, [in][out]. The product is added to `added_to`, which becomes the output.
memory OnednnGraph::product(const TensorView& weight, const TensorView* bias, bool relu, const memory& in,
                            const memory* added_to) {
  const memory::dim inputs = in.get_desc().dims()[1],
                    outputs = static_cast<memory::dim>(weight.size) / inputs;
  const memory::desc in_desc({1, inputs}, Type::f32, Tag::nc), out_desc({1, outputs}, Type::f32, Tag::nc),
      any_weights({outputs, inputs}, Type::f32, Tag::any),
      bias_desc = bias != nullptr ? memory::desc({outputs}, Type::f32, Tag::x) : memory::desc();
  dnnl::post_ops then;
  if (added_to != nullptr) then.append_sum(1.0F);
  if (relu) then.append_eltwise(1.0F, dnnl::algorithm::eltwise_relu, 0.0F, 0.0F);
  dnnl::primitive_attr attributes;
  attributes.set_post_ops(then);
  const inner_product_forward::primitive_desc primitive(
      inner_product_forward::desc(kInference, in_desc, any_weights, bias_desc, out_desc), attributes,
      engine_);
  memory out = added_to != nullptr ? *added_to : memory(out_desc, engine_);
  Arguments arguments{
      {DNNL_ARG_SRC, in},
      {DNNL_ARG_WEIGHTS,
       weights_in_format(weight.data, {{outputs, inputs}, Type::f32, Tag::io}, primitive.weights_desc())},
      {DNNL_ARG_DST, out}};
  if (bias != nullptr)
    arguments.insert({DNNL_ARG_BIAS, weights_in_format(bias->data, bias_desc, primitive.bias_desc())});
  step(inner_product_forward(primitive), arguments);
  return out;
}

memory OnednnGraph::readable(const memory& in) {
  const memory::dims dims = in.get_desc().dims();
  return in_format(in, {dims, in.get_desc().data_type(), dims.size() == 4 ? Tag::nhwc : Tag::nc});
}

void OnednnGraph::run() {
  for (const Step& step : steps_) step.primitive.execute(stream_, step.arguments);
  stream_.wait();
}

}  // namespace tumblesight::sim
