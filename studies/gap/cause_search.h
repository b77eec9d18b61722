#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capstan/gap/candidate_cause.h"
#include "capstan/gap/cause_fit.h"
#include "capstan/gap/evidence.h"
#include "capstan/gap/screening.h"

namespace capstan::gap {

struct CauseSearchOptions {
    int segments = 40;  ///< of a cable
    int stride = 1;     ///< every how manieth sample a step goes to
    int threads = 0;    ///< 0: as many as the machine has
    /// Told what is going on, and how much of the work is done.
    std::function<void(const std::string& doing, double fraction_done)> on_progress = [](const std::string&,
                                                                                         double) {};
};

/// What was fitted, best first.
struct FoundCauses {
    std::vector<ScoredFit> singles;
    std::vector<ScoredFit> pairs;
    double nominal_misfit = 0.0;
    int evaluations = 0;  ///< simulations of the whole recording
};

/// Looks for what could be behind a recording's gap: every cause at a glance, the most promising in full, and
/// where much is left the best with a second.
class CauseSearch {
  public:
    /// `recording` must outlive it and what it finds.
    CauseSearch(const Recording& recording, const CauseSearchOptions& options);

    FoundCauses run();

    const CauseFitter& fitter() const { return fitter_; }
    const CauseFitter& coarse_fitter() const { return screener_; }
    const Evidence& evidence() const { return evidence_; }
    const std::vector<CandidateCause>& causes() const { return causes_; }

  private:
    void tell(const std::string& doing, double done) { options_.on_progress(doing, done); }
    ScoredFit scored(CauseFit fit);
    void fit_best(const std::vector<Screened>& screened, std::vector<ScoredFit>& fits);
    void fit_confusable(const std::vector<Screened>& screened, std::vector<ScoredFit>& singles);
    std::vector<ScoredFit> pairs_with(const std::vector<ScoredFit>& singles);
    void add_pairs(const Hypothesis& present, std::vector<ScoredFit>& pairs);

    CauseSearchOptions options_;
    CauseFitter fitter_;
    CauseFitter screener_;
    Evidence evidence_;
    std::vector<CandidateCause> causes_;
    Hypothesis nominal_;  // nothing fitted: where searches start, for the nominal fit may have gone astray
    double nominal_misfit_ = 0.0;
    int evaluations_ = 0;
};

/// In place, the best first.
void sort_by_evidence(std::vector<ScoredFit>& fits);

}  // namespace capstan::gap
