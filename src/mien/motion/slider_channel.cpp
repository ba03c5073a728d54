#include "mien/motion/detail/slider_channel.h"

namespace mien::detail {

Channel slider_channel(int slider, const std::vector<double>& seconds, const Eigen::VectorXd& values) {
  Channel channel;
  channel.property = Channel::Property::slider;
  channel.slider = slider;
  for (std::size_t f = 0; f < seconds.size(); ++f) {
    channel.times.push_back(static_cast<float>(seconds[f]));
    channel.values.push_back(static_cast<float>(values[static_cast<Eigen::Index>(f)]));
  }
  return channel;
}

}  // namespace mien::detail
