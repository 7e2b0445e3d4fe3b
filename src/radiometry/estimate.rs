//! A mean of random samples, by a weight whose mean is known.

/// Sums over samples `x = w` where light arrives and `x = 0` where not; the mean of the weights `w` is known.
///
/// The known mean takes out what the weights contribute to the variance (a regression control variate; Owen 2013, "Monte Carlo theory,
/// methods and examples", section 8.9). Its coefficient comes from the samples, which biases the mean by the order of 1 / count, far below
/// the standard error.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Estimate {
    known_mean: f64,
    count: u64,
    /// Of those whose weight is not 0.
    lit_count: u64,
    hidden_count: u64,
    /// Of `w - known_mean`, so that nothing cancels.
    weights: f64,
    squared_weights: f64,
    /// Of `x - known_mean`.
    samples: f64,
    squared_samples: f64,
    products: f64,
}

impl Estimate {
    pub(super) fn new(known_mean: f64) -> Self {
        Self { known_mean, ..Self::default() }
    }

    pub(super) fn add(&mut self, weight: f64, is_lit: bool) {
        self.count += 1;
        self.lit_count += u64::from(is_lit && weight > 0.0);
        self.hidden_count += u64::from(!is_lit && weight > 0.0);
        let weight = weight - self.known_mean;
        let sample = if is_lit { weight } else { -self.known_mean };
        self.weights += weight;
        self.squared_weights += weight * weight;
        self.samples += sample;
        self.squared_samples += sample * sample;
        self.products += weight * sample;
    }

    /// As if the other's samples had been added.
    pub(super) fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.lit_count += other.lit_count;
        self.hidden_count += other.hidden_count;
        self.weights += other.weights;
        self.squared_weights += other.squared_weights;
        self.samples += other.samples;
        self.squared_samples += other.squared_samples;
        self.products += other.products;
    }

    /// How many of the samples had to be looked at.
    pub(super) fn ray_count(&self) -> u64 {
        self.lit_count + self.hidden_count
    }

    /// The mean and its standard error. Where all samples agree, the known mean or 0, both exactly, and no error.
    pub(super) fn mean_and_error(&self) -> (f64, f64) {
        /// Of the known mean: weights that vary less are not worth a coefficient. Those of a lamp that is seen under 1e-7 vary less than the
        /// closed form rounds, which an undamped coefficient made 40 standard errors of.
        const LEAST_SPREAD: f64 = 1.0 / 1024.0;

        if self.lit_count == 0 {
            return (0.0, 0.0);
        }
        if self.hidden_count == 0 {
            return (self.known_mean, 0.0);
        }
        let count = self.count as f64;
        let (mean_weight, mean_sample) = (self.weights / count, self.samples / count);
        let weight_variance = self.squared_weights / count - mean_weight * mean_weight;
        let sample_variance = self.squared_samples / count - mean_sample * mean_sample;
        let covariance = self.products / count - mean_weight * mean_sample;
        let least_spread = LEAST_SPREAD * self.known_mean;
        let coefficient = covariance / (weight_variance + least_spread * least_spread);
        let residual = (sample_variance - coefficient * (2.0 * covariance - coefficient * weight_variance)).max(0.0);
        let mean = self.known_mean + mean_sample - coefficient * mean_weight;
        // Two are taken by the mean and the coefficient.
        let error = (residual / (count - 2.0).max(1.0)).sqrt();
        (mean.clamp(0.0, self.known_mean), error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_that_agree_are_exact() {
        let mut estimate = Estimate::new(0.7);
        for weight in [0.5, 0.8, 0.9] {
            estimate.add(weight, true);
        }
        estimate.add(0.0, false);
        assert_eq!((estimate.mean_and_error(), estimate.ray_count()), ((0.7, 0.0), 3));
        let mut estimate = Estimate::new(0.7);
        for weight in [0.5, 0.8, 0.9] {
            estimate.add(weight, false);
        }
        assert_eq!(estimate.mean_and_error(), (0.0, 0.0));
    }

    #[test]
    fn weights_that_vary_less_than_the_known_mean_rounds_leave_the_share() {
        let mut estimate = Estimate::new(1.0);
        for index in 0..1000 {
            let is_lit = index % 4 == 0;
            estimate.add(1.0 + 1e-8 + if is_lit { 1e-14 } else { 0.0 }, is_lit);
        }
        let (mean, error) = estimate.mean_and_error();
        assert!((mean - 0.25).abs() < 1e-3 * error, "{mean} +- {error}");
    }

    #[test]
    fn equal_weights_leave_a_share_with_its_binomial_error() {
        let mut estimate = Estimate::new(2.0);
        for index in 0..1000 {
            estimate.add(2.0, index % 4 == 0);
        }
        let (mean, error) = estimate.mean_and_error();
        assert_eq!(mean, 0.5);
        assert!((error / (2.0 * (0.25 * 0.75 / 998.0f64).sqrt()) - 1.0).abs() < 1e-12, "{error}");
    }
}
