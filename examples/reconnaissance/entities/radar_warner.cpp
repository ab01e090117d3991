#include "radar_warner.hpp"

#include <fmt/format.h>

#include "deciding.hpp"
#include "threats/emitter_classification.hpp"
#include "topics.hpp"

namespace reconnaissance {

RadarWarner::RadarWarner(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      intercepts_(entity, topic::kIntercepts, {}),
      reports_(entity.publisher<recon::EmitterReports>(topic::kEmitters.name)),
      member_(entity, values, [this](Tick tick) { warn(tick); }) {}

void RadarWarner::warn(Tick tick) {
  recon::EmitterReports told{tick, {}};
  for (const recon::Intercepts& batch : intercepts_.take(tick)) {
    for (const recon::Intercept& each : batch.intercepts) {
      auto& train = trains_[each.train];
      train.intercepts.push_back(each);
      if (train.intercepts.size() > kWidebandIntercepts)
        train.intercepts.erase(train.intercepts.begin());
      told.reports.push_back({each, identify(train, each.train)});
    }
  }
  reports_.publish(told);
}

/// All classifiers are asked; who is not sure has no vote.
recon::Identification RadarWarner::identify(const recon::PulseTrain& train, std::uint32_t number) {
  skein::Task<recon::IEmitterClassifier, recon::Identification> task;
  task.request = fmt::format("emitter {}", number);
  task.execution = skein::Execution::All;
  task.enough = skein::TaskOptions::kAll;
  task.run = [&](recon::IEmitterClassifier::Proxy& classifier, skein::Duration) {
    return classifier.async_classify(train);
  };
  task.evaluate.check("is a probability",
                      [](const recon::Identification& found) -> std::optional<std::string> {
                        if (found.confidence >= 0 && found.confidence <= 1) return std::nullopt;
                        return fmt::format("its confidence is {}", found.confidence);
                      });
  task.synthesis =
      by_names(identification_vote<recon::Identification>(emitter_library().size() + 1));
  return decide(entity_, task).value_or(recon::Identification{});
}

}  // namespace reconnaissance
