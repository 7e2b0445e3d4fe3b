//! How bright light of a wavelength looks, and so from radiant to luminous quantities.

use super::error::RadiometryError;

/// `K_m`, the luminous efficacy of light at 555 nm, where the eye is most sensitive [lm/W].
///
/// Source: "Principles governing photometry", BIPM monograph, 2nd edition 2019: 683 lm/W at 540 THz defines the candela; at the
/// peak of V, 0.2 nm off, it is 683.002, which the CIE rounds to 683.
pub const MAX_LUMINOUS_EFFICACY_LM_PER_W: f64 = 683.0;

/// Lumens for each watt of some light: at most [`MAX_LUMINOUS_EFFICACY_LM_PER_W`].
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct LuminousEfficacy {
    lm_per_w: f64,
}

impl LuminousEfficacy {
    /// Of light of one wavelength: `K_m V(lambda)`.
    pub fn of_wavelength(wavelength_nm: f64) -> Self {
        Self { lm_per_w: MAX_LUMINOUS_EFFICACY_LM_PER_W * photopic_luminosity(wavelength_nm) }
    }

    /// Of light with a spectrum: `K_m` times the integral of `V(lambda)` times the power, over that of the power.
    ///
    /// `spectral_powers` are in any one unit for each nanometre, one for each of the rising `wavelengths_nm`, and change linearly in
    /// between; a single one is a line. V is linear between its nanometres, and the integral of the product exact.
    pub fn of_spectrum(wavelengths_nm: &[f64], spectral_powers: &[f64]) -> Result<Self, RadiometryError> {
        check_spectrum(wavelengths_nm, spectral_powers)?;
        if let &[wavelength_nm] = wavelengths_nm {
            return Ok(Self::of_wavelength(wavelength_nm));
        }
        // In units of the largest, so that no sum overflows.
        let largest = spectral_powers.iter().copied().fold(0.0, f64::max);
        let (mut power, mut visible) = (0.0, 0.0);
        for (ends, powers) in wavelengths_nm.windows(2).zip(spectral_powers.windows(2)) {
            let segment = Segment { ends: [ends[0], ends[1]], powers: [powers[0] / largest, powers[1] / largest] };
            power += 0.5 * (segment.powers[0] + segment.powers[1]) * (ends[1] - ends[0]);
            visible += segment.visible_power();
        }
        Ok(Self { lm_per_w: MAX_LUMINOUS_EFFICACY_LM_PER_W * visible / power })
    }

    /// Where it is known from a data sheet, `flux / power` for example [lm/W].
    pub fn new(lm_per_w: f64) -> Self {
        Self { lm_per_w }
    }

    /// [lm/W]
    pub fn value(self) -> f64 {
        self.lm_per_w
    }
}

/// A piece of a spectrum along which the power changes linearly.
struct Segment {
    ends: [f64; 2],
    powers: [f64; 2],
}

impl Segment {
    fn power(&self, wavelength_nm: f64) -> f64 {
        let [from, to] = self.ends;
        let weight = (wavelength_nm - from) / (to - from);
        (1.0 - weight) * self.powers[0] + weight * self.powers[1]
    }

    /// The integral of V times the power. Between whole nanometres both are linear and Simpson's rule is exact.
    fn visible_power(&self) -> f64 {
        let (from, to) = (self.ends[0].max(FIRST_NM), self.ends[1].min(LAST_NM));
        let mut sum = 0.0;
        let mut start = from;
        while start < to {
            let end = (start.floor() + 1.0).min(to);
            let product = |wavelength_nm: f64| photopic_luminosity(wavelength_nm) * self.power(wavelength_nm);
            sum += (end - start) / 6.0 * (product(start) + 4.0 * product(0.5 * (start + end)) + product(end));
            start = end;
        }
        sum
    }
}

fn check_spectrum(wavelengths_nm: &[f64], spectral_powers: &[f64]) -> Result<(), RadiometryError> {
    if wavelengths_nm.is_empty() || wavelengths_nm.len() != spectral_powers.len() {
        return Err(RadiometryError::SpectrumLength {
            wavelength_count: wavelengths_nm.len(),
            power_count: spectral_powers.len(),
        });
    }
    for (index, &wavelength_nm) in wavelengths_nm.iter().enumerate() {
        let rises = index == 0 || wavelengths_nm[index - 1] < wavelength_nm;
        if !(wavelength_nm > 0.0 && wavelength_nm.is_finite() && rises) {
            return Err(RadiometryError::Wavelength { index, wavelength_nm });
        }
    }
    let is_power = |power: f64| power >= 0.0 && power.is_finite();
    if let Some(index) = spectral_powers.iter().position(|&power| !is_power(power)) {
        return Err(RadiometryError::SpectralPower { index, power: spectral_powers[index] });
    }
    if spectral_powers.iter().all(|&power| power == 0.0) {
        return Err(RadiometryError::DarkSpectrum);
    }
    Ok(())
}

/// `V(lambda)`, the sensitivity of the eye in daylight relative to its peak at 555 nm; linear between whole nanometres, 0 outside
/// 360 to 830 nm, and for a NaN.
///
/// Source: CIE 1924, as tabulated in ISO/CIE 23539:2023, table 1.
pub fn photopic_luminosity(wavelength_nm: f64) -> f64 {
    if !(FIRST_NM..=LAST_NM).contains(&wavelength_nm) {
        return 0.0;
    }
    let below = (wavelength_nm - FIRST_NM).floor();
    let weight = wavelength_nm - FIRST_NM - below;
    let index = below as usize;
    let above = PHOTOPIC_LUMINOSITY.get(index + 1).copied().unwrap_or(0.0);
    (1.0 - weight) * PHOTOPIC_LUMINOSITY[index] + weight * above
}

const FIRST_NM: f64 = 360.0;
const LAST_NM: f64 = FIRST_NM + (PHOTOPIC_LUMINOSITY.len() - 1) as f64;

/// `V(lambda)` from 360 to 830 nm, one a nanometre. Source: see [`photopic_luminosity`].
const PHOTOPIC_LUMINOSITY: [f64; 471] = [
    3.917e-6,
    4.393_581e-6,
    4.929_604e-6,
    5.532_136e-6,
    6.208_245e-6,
    6.965e-6,
    7.813_219e-6,
    8.767_336e-6,
    9.839_844e-6,
    1.104_323e-5,
    1.239e-5,
    1.388_641e-5,
    1.555_728e-5,
    1.744_296e-5,
    1.958_375e-5,
    2.202e-5,
    2.483_965e-5,
    2.804_126e-5,
    3.153_104e-5,
    3.521_521e-5,
    3.9e-5,
    4.282_64e-5,
    4.691_46e-5,
    5.158_96e-5,
    5.717_64e-5,
    6.4e-5,
    7.234_421e-5,
    8.221_224e-5,
    9.350_816e-5,
    0.000_106_136_1,
    0.000_12,
    0.000_134_984,
    0.000_151_492,
    0.000_170_208,
    0.000_191_816,
    0.000_217,
    0.000_246_906_7,
    0.000_281_24,
    0.000_318_52,
    0.000_357_266_7,
    0.000_396,
    0.000_433_714_7,
    0.000_473_024,
    0.000_517_876,
    0.000_572_218_7,
    0.000_64,
    0.000_724_56,
    0.000_825_5,
    0.000_941_16,
    0.001_069_88,
    0.001_21,
    0.001_362_091,
    0.001_530_752,
    0.001_720_368,
    0.001_935_323,
    0.002_18,
    0.002_454_8,
    0.002_764,
    0.003_117_8,
    0.003_526_4,
    0.004,
    0.004_546_24,
    0.005_159_32,
    0.005_829_28,
    0.006_546_16,
    0.007_3,
    0.008_086_507,
    0.008_908_72,
    0.009_767_68,
    0.010_664_43,
    0.011_6,
    0.012_573_17,
    0.013_582_72,
    0.014_629_68,
    0.015_715_09,
    0.016_84,
    0.018_007_36,
    0.019_214_48,
    0.020_453_92,
    0.021_718_24,
    0.023,
    0.024_294_61,
    0.025_610_24,
    0.026_958_57,
    0.028_351_25,
    0.029_8,
    0.031_310_83,
    0.032_883_68,
    0.034_521_12,
    0.036_225_71,
    0.038,
    0.039_846_67,
    0.041_768,
    0.043_766,
    0.045_842_67,
    0.048,
    0.050_243_68,
    0.052_573_04,
    0.054_980_56,
    0.057_458_72,
    0.06,
    0.062_601_97,
    0.065_277_52,
    0.068_042_08,
    0.070_911_09,
    0.073_9,
    0.077_016,
    0.080_266_4,
    0.083_666_8,
    0.087_232_8,
    0.090_98,
    0.094_917_55,
    0.099_045_84,
    0.103_367_4,
    0.107_884_6,
    0.112_6,
    0.117_532,
    0.122_674_4,
    0.127_992_8,
    0.133_452_8,
    0.139_02,
    0.144_676_4,
    0.150_469_3,
    0.156_461_9,
    0.162_717_7,
    0.169_3,
    0.176_243_1,
    0.183_558_1,
    0.191_273_5,
    0.199_418,
    0.208_02,
    0.217_119_9,
    0.226_734_5,
    0.236_857_1,
    0.247_481_2,
    0.258_6,
    0.270_184_9,
    0.282_293_9,
    0.295_050_5,
    0.308_578,
    0.323,
    0.338_402_1,
    0.354_685_8,
    0.371_698_6,
    0.389_287_5,
    0.407_3,
    0.425_629_9,
    0.444_309_6,
    0.463_394_4,
    0.482_939_5,
    0.503,
    0.523_569_3,
    0.544_512,
    0.565_69,
    0.586_965_3,
    0.608_2,
    0.629_345_6,
    0.650_306_8,
    0.670_875_2,
    0.690_842_4,
    0.71,
    0.728_185_2,
    0.745_463_6,
    0.761_969_4,
    0.777_836_8,
    0.793_2,
    0.808_110_4,
    0.822_496_2,
    0.836_306_8,
    0.849_491_6,
    0.862,
    0.873_810_8,
    0.884_962_4,
    0.895_493_6,
    0.905_443_2,
    0.914_850_1,
    0.923_734_8,
    0.932_092_4,
    0.939_922_6,
    0.947_225_2,
    0.954,
    0.960_256_1,
    0.966_007_4,
    0.971_260_6,
    0.976_022_5,
    0.980_3,
    0.984_092_4,
    0.987_418_2,
    0.990_312_8,
    0.992_811_6,
    0.994_950_1,
    0.996_710_8,
    0.998_098_3,
    0.999_112,
    0.999_748_2,
    1.0,
    0.999_856_7,
    0.999_304_6,
    0.998_325_5,
    0.996_898_7,
    0.995,
    0.992_600_5,
    0.989_742_6,
    0.986_444_4,
    0.982_724_1,
    0.978_6,
    0.974_083_7,
    0.969_171_2,
    0.963_856_8,
    0.958_134_9,
    0.952,
    0.945_450_4,
    0.938_499_2,
    0.931_162_8,
    0.923_457_6,
    0.915_4,
    0.907_006_4,
    0.898_277_2,
    0.889_204_8,
    0.879_781_6,
    0.87,
    0.859_861_3,
    0.849_392,
    0.838_622,
    0.827_581_3,
    0.816_3,
    0.804_794_7,
    0.793_082,
    0.781_192,
    0.769_154_7,
    0.757,
    0.744_754_1,
    0.732_422_4,
    0.720_003_6,
    0.707_496_5,
    0.694_9,
    0.682_219_2,
    0.669_471_6,
    0.656_674_4,
    0.643_844_8,
    0.631,
    0.618_155_5,
    0.605_314_4,
    0.592_475_6,
    0.579_637_9,
    0.566_8,
    0.553_961_1,
    0.541_137_2,
    0.528_352_8,
    0.515_632_3,
    0.503,
    0.490_468_8,
    0.478_030_4,
    0.465_677_6,
    0.453_403_2,
    0.441_2,
    0.429_08,
    0.417_036,
    0.405_032,
    0.393_032,
    0.381,
    0.368_918_4,
    0.356_827_2,
    0.344_776_8,
    0.332_817_6,
    0.321,
    0.309_338_1,
    0.297_850_4,
    0.286_593_6,
    0.275_624_5,
    0.265,
    0.254_763_2,
    0.244_889_6,
    0.235_334_4,
    0.226_052_8,
    0.217,
    0.208_161_6,
    0.199_548_8,
    0.191_155_2,
    0.182_974_4,
    0.175,
    0.167_223_5,
    0.159_646_4,
    0.152_277_6,
    0.145_125_9,
    0.138_2,
    0.131_500_3,
    0.125_024_8,
    0.118_779_2,
    0.112_769_1,
    0.107,
    0.101_476_2,
    0.096_188_64,
    0.091_122_96,
    0.086_264_85,
    0.081_6,
    0.077_120_64,
    0.072_825_52,
    0.068_710_08,
    0.064_769_76,
    0.061,
    0.057_396_21,
    0.053_955_04,
    0.050_673_76,
    0.047_549_65,
    0.044_58,
    0.041_758_72,
    0.039_084_96,
    0.036_563_84,
    0.034_200_48,
    0.032,
    0.029_962_61,
    0.028_076_64,
    0.026_329_36,
    0.024_708_05,
    0.023_2,
    0.021_800_77,
    0.020_501_12,
    0.019_281_08,
    0.018_120_69,
    0.017,
    0.015_903_79,
    0.014_837_18,
    0.013_810_68,
    0.012_834_78,
    0.011_92,
    0.011_068_31,
    0.010_273_39,
    0.009_533_311,
    0.008_846_157,
    0.008_21,
    0.007_623_781,
    0.007_085_424,
    0.006_591_476,
    0.006_138_485,
    0.005_723,
    0.005_343_059,
    0.004_995_796,
    0.004_676_404,
    0.004_380_075,
    0.004_102,
    0.003_838_453,
    0.003_589_099,
    0.003_354_219,
    0.003_134_093,
    0.002_929,
    0.002_738_139,
    0.002_559_876,
    0.002_393_244,
    0.002_237_275,
    0.002_091,
    0.001_953_587,
    0.001_824_58,
    0.001_703_58,
    0.001_590_187,
    0.001_484,
    0.001_384_496,
    0.001_291_268,
    0.001_204_092,
    0.001_122_744,
    0.001_047,
    0.000_976_589_6,
    0.000_911_108_8,
    0.000_850_133_2,
    0.000_793_238_4,
    0.000_74,
    0.000_690_082_7,
    0.000_643_31,
    0.000_599_496,
    0.000_558_454_7,
    0.000_52,
    0.000_483_913_6,
    0.000_450_052_8,
    0.000_418_345_2,
    0.000_388_718_4,
    0.000_361_1,
    0.000_335_383_5,
    0.000_311_440_4,
    0.000_289_165_6,
    0.000_268_453_9,
    0.000_249_2,
    0.000_231_301_9,
    0.000_214_685_6,
    0.000_199_288_4,
    0.000_185_047_5,
    0.000_171_9,
    0.000_159_778_1,
    0.000_148_604_4,
    0.000_138_301_6,
    0.000_128_792_5,
    0.000_12,
    0.000_111_859_5,
    0.000_104_322_4,
    9.733_56e-5,
    9.084_587e-5,
    8.48e-5,
    7.914_667e-5,
    7.385_8e-5,
    6.891_6e-5,
    6.430_267e-5,
    6e-5,
    5.598_187e-5,
    5.222_56e-5,
    4.871_84e-5,
    4.544_747e-5,
    4.24e-5,
    3.956_104e-5,
    3.691_512e-5,
    3.444_868e-5,
    3.214_816e-5,
    3e-5,
    2.799_125e-5,
    2.611_356e-5,
    2.436_024e-5,
    2.272_461e-5,
    2.12e-5,
    1.977_855e-5,
    1.845_285e-5,
    1.721_687e-5,
    1.606_459e-5,
    1.499e-5,
    1.398_728e-5,
    1.305_155e-5,
    1.217_818e-5,
    1.136_254e-5,
    1.06e-5,
    9.885_877e-6,
    9.217_304e-6,
    8.592_362e-6,
    8.009_133e-6,
    7.465_7e-6,
    6.959_567e-6,
    6.487_995e-6,
    6.048_699e-6,
    5.639_396e-6,
    5.257_8e-6,
    4.901_771e-6,
    4.569_72e-6,
    4.260_194e-6,
    3.971_739e-6,
    3.702_9e-6,
    3.452_163e-6,
    3.218_302e-6,
    3.000_3e-6,
    2.797_139e-6,
    2.607_8e-6,
    2.431_22e-6,
    2.266_531e-6,
    2.113_013e-6,
    1.969_943e-6,
    1.836_6e-6,
    1.712_23e-6,
    1.596_228e-6,
    1.488_09e-6,
    1.387_314e-6,
    1.293_4e-6,
    1.205_82e-6,
    1.124_143e-6,
    1.048_009e-6,
    9.770_578e-7,
    9.109_3e-7,
    8.492_513e-7,
    7.917_212e-7,
    7.380_904e-7,
    6.881_098e-7,
    6.415_3e-7,
    5.980_895e-7,
    5.575_746e-7,
    5.198_08e-7,
    4.846_123e-7,
    4.518_1e-7,
];

#[cfg(test)]
mod tests {
    use super::super::quantity::RadiantFlux;
    use super::*;

    #[test]
    fn luminosity_has_the_published_values() {
        assert_eq!(PHOTOPIC_LUMINOSITY.iter().copied().fold(0.0, f64::max), photopic_luminosity(555.0));
        // CIE S 010: of the 5 nm table.
        for (wavelength_nm, published) in
            [(380.0, 0.000_039), (450.0, 0.038), (507.0, 0.444_31), (600.0, 0.631), (700.0, 0.004_102)]
        {
            let relative = photopic_luminosity(wavelength_nm) / published - 1.0;
            assert!(relative.abs() < 2e-3, "{wavelength_nm} nm: {relative}"); // the table's last digit
        }
        for outside in [359.9, 830.1, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(photopic_luminosity(outside), 0.0, "{outside}");
        }
        assert_eq!(photopic_luminosity(830.0), 4.5181e-7);
    }

    #[test]
    fn efficacy_of_a_line_is_that_of_its_wavelength() {
        assert_eq!(LuminousEfficacy::of_wavelength(555.0).value(), 683.0);
        let line = LuminousEfficacy::of_spectrum(&[532.0], &[0.005]).expect("valid");
        assert_eq!(line, LuminousEfficacy::of_wavelength(532.0));
        // A green laser pointer: V(532) = 0.8849.
        let flux = RadiantFlux::new(0.005).luminous(line).value();
        assert!((flux - 0.005 * 683.0 * 0.884_9).abs() < 1e-3, "{flux}");
        let narrow =
            LuminousEfficacy::of_spectrum(&[531.999, 532.0, 532.001], &[0.0, 1.0, 0.0]).expect("valid").value();
        assert!((narrow / line.value() - 1.0).abs() < 1e-4, "{narrow}");
    }

    #[test]
    fn efficacy_of_an_equal_energy_spectrum_is_the_mean_of_v() {
        let efficacy = LuminousEfficacy::of_spectrum(&[360.0, 830.0], &[2.0, 2.0]).expect("valid").value();
        let sum: f64 = PHOTOPIC_LUMINOSITY.iter().sum();
        let trapezoid = sum - 0.5 * (PHOTOPIC_LUMINOSITY[0] + PHOTOPIC_LUMINOSITY[470]);
        assert!((efficacy / (683.0 * trapezoid / 470.0) - 1.0).abs() < 1e-13, "{efficacy}");
        // Cutting a spectrum into pieces changes nothing.
        let pieces = LuminousEfficacy::of_spectrum(&[360.0, 400.3, 555.5, 830.0], &[2.0; 4]).expect("valid").value();
        assert!((efficacy / pieces - 1.0).abs() < 1e-13, "{pieces}");
    }

    /// Planck's law in terms of wavelength, up to a factor; CODATA 2018's second radiation constant.
    fn black_body(kelvin: f64) -> (Vec<f64>, Vec<f64>) {
        const C2_NM_KELVIN: f64 = 1.438_776_877e7;
        let wavelengths: Vec<f64> = (100..100_000).map(f64::from).collect();
        let power = |nm: f64| 1e15 / (nm.powi(5) * (C2_NM_KELVIN / (nm * kelvin)).exp_m1());
        let powers = wavelengths.iter().map(|&nm| power(nm)).collect();
        (wavelengths, powers)
    }

    #[test]
    fn efficacy_of_black_bodies_is_the_published_one() {
        let efficacy = |kelvin| {
            let (wavelengths_nm, powers) = black_body(kelvin);
            LuminousEfficacy::of_spectrum(&wavelengths_nm, &powers).expect("valid").value()
        };
        // The candela's old definition: 60 cd/cm^2 at the freezing point of platinum, 2041.4 K; 683 lm/W was chosen to keep it within 1 %.
        const STEFAN_BOLTZMANN_W_PER_M2_K4: f64 = 5.670_374_419e-8;
        let exitance_lx = efficacy(2041.4) * STEFAN_BOLTZMANN_W_PER_M2_K4 * 2041.4f64.powi(4);
        let luminance_nt = exitance_lx / std::f64::consts::PI;
        assert!((luminance_nt / 600_000.0 - 1.0).abs() < 1e-2, "{luminance_nt}");
        // The most that a black body has, some 95 lm/W near 6640 K.
        let most = efficacy(6640.0);
        assert!(most > efficacy(5500.0) && most > efficacy(8000.0) && (most - 95.0).abs() < 1.0, "{most}");
    }

    #[test]
    fn spectra_that_are_none_are_refused() {
        let refused = |wavelengths_nm: &[f64], powers: &[f64]| {
            LuminousEfficacy::of_spectrum(wavelengths_nm, powers).expect_err("it is none").to_string()
        };
        assert_eq!(
            refused(&[], &[]),
            "a spectrum needs a power for each of at least one wavelength: 0 wavelengths, 0 powers"
        );
        assert!(refused(&[500.0, 500.0], &[1.0, 1.0]).contains("wavelength 1 is 500 nm"));
        assert!(refused(&[500.0, f64::NAN], &[1.0, 1.0]).contains("wavelength 1 is NaN nm"));
        assert!(refused(&[500.0, 600.0], &[1.0, -2.0]).contains("power 1 is -2"));
        assert!(refused(&[500.0, 600.0], &[0.0, 0.0]).contains("no power"));
    }
}
