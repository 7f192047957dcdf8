//! The colour map of pictures.

/// Nine colours of viridis at equal distances, sRGB (van der Walt & Smith 2015, matplotlib; public domain, CC0).
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// The colour of a part `x` of the range, sRGB from 0 to 1; beyond the range, the colour of its end.
pub(super) fn viridis(x: f64) -> [f64; 3] {
    let place = x.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let before = (place as usize).min(VIRIDIS.len() - 2);
    let part = place - before as f64;
    std::array::from_fn(|i| {
        let (from, to) = (f64::from(VIRIDIS[before][i]), f64::from(VIRIDIS[before + 1][i]));
        (from + (to - from) * part) / 255.0
    })
}

/// An sRGB colour in linear light (IEC 61966-2-1), as glTF has vertex colours.
pub(super) fn linear(srgb: [f64; 3]) -> [f32; 3] {
    srgb.map(|c| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) } as f32)
}
