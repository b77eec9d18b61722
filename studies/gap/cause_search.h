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
    int stride = 1;     ///< samples per step
    int threads = 0;    ///< 0: as many as the machine has
    /// Called with the present activity and the fraction of the work that is done.
    std::function<void(const std::string& activity, double fraction_done)> on_progress =
        [](const std::string&, double) {};
};

/// All fits, best first.
struct FoundCauses {
    std::vector<ScoredFit> singles;
    std::vector<ScoredFit> pairs;
    double nominal_misfit = 0.0;
    int evaluations = 0;  ///< simulations of the complete recording
};

/// Searches the causes of a recording's gap: screens every cause, fits the most promising ones, and where
/// much is left fits the best of them together with a second.
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
    void report(const std::string& activity, double done) { options_.on_progress(activity, done); }
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
    Hypothesis nominal_;  // nothing fitted: where every search starts
    double nominal_misfit_ = 0.0;
    int evaluations_ = 0;
};

/// In place, best first.
void sort_by_evidence(std::vector<ScoredFit>& fits);

}  // namespace capstan::gap
