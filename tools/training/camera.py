"""What a camera does to an image: light, colours, blur, noise, compression.

Images are 8-bit BGR."""

import cv2
import numpy as np

NOISE_SIZE = 700  # pixels, of the square that noise is cut from
LARGEST_RADIUS = 7  # pixels, of a blur


def colours(rng, image, strength=1.0):
    """Gamma, exposure, white balance, contrast, saturation."""
    gains = np.exp(rng.normal(0, 0.22 * strength) + rng.normal(0, 0.09 * strength, 3))
    levels = (np.arange(256) / 255) ** np.exp(rng.normal(0, 0.25 * strength))
    levels = levels[:, None] * gains
    mean = np.mean(cv2.mean(image)[:3]) / 255
    levels = (levels - mean) * rng.uniform(1 - 0.45 * strength, 1 + 0.35 * strength) + mean
    table = np.round(np.clip(levels, 0, 1) * 255).astype(np.uint8)
    saturation = 0 if rng.random() < 0.06 else rng.uniform(0.3, 1.4)
    mixing = np.eye(3) * saturation + (1 - saturation) / 3
    return cv2.transform(cv2.LUT(image, table[None]), mixing)


def blur_kernel(rng):
    """Out of focus and moved: a Gaussian, longer along one direction; or a straight motion."""
    motion = rng.random() < 0.3
    long = np.exp(rng.uniform(np.log(0.4), np.log(3.5)))
    short = min(long, np.exp(rng.uniform(np.log(0.25), np.log(1.4))))
    radius = LARGEST_RADIUS if motion else min(LARGEST_RADIUS, int(2 * long) + 1)
    v, u = np.mgrid[-radius:radius + 1, -radius:radius + 1].astype(np.float32)
    angle = rng.uniform(0, np.pi)
    along, across = u * np.cos(angle) + v * np.sin(angle), v * np.cos(angle) - u * np.sin(angle)
    if motion:
        length = rng.uniform(1, radius)
        kernel = np.clip(length - np.abs(along), 0, 1) * np.clip(1 - np.abs(across), 0, 1)
    else:
        kernel = np.exp(-0.5 * ((along / long) ** 2 + (across / short) ** 2))
    return kernel / kernel.sum()


def compressed(rng, image):
    quality = [cv2.IMWRITE_JPEG_QUALITY, int(rng.integers(30, 95))]
    return cv2.imdecode(cv2.imencode('.jpg', image, quality)[1], cv2.IMREAD_COLOR)


class Camera:
    def __init__(self):
        shape = (NOISE_SIZE, NOISE_SIZE, 3)
        self.noise = np.random.default_rng(0).standard_normal(shape, np.float32)

    def _noise(self, rng, height, width):
        y, x = (int(rng.integers(NOISE_SIZE - side + 1)) for side in (height, width))
        return self.noise[y:y + height, x:x + width]

    def _noisy(self, rng, image):
        """Noise of single pixels, and of small patches, as after a camera's own interpolation."""
        height, width = image.shape[:2]
        coarse = cv2.resize(self._noise(rng, height // 3, width // 3), (width, height))
        fine = np.ascontiguousarray(self._noise(rng, height, width))
        both = cv2.addWeighted(fine, rng.random() ** 2 * 18, coarse, rng.random() ** 2 * 13, 0)
        return cv2.add(image, both, dtype=cv2.CV_8U)

    def photograph(self, rng, image):
        """The image as a frame of some camera."""
        if rng.random() < 0.5:
            image = cv2.filter2D(image, -1, blur_kernel(rng), borderType=cv2.BORDER_REFLECT_101)
        image = colours(rng, image, 0.9)
        if rng.random() < 0.2:  # blown highlights
            image = cv2.convertScaleAbs(image, alpha=rng.uniform(1.1, 1.6))
        if rng.random() < 0.2:
            height, width = image.shape[:2]
            small = cv2.resize(image, (width // 2, height // 2), interpolation=cv2.INTER_AREA)
            image = cv2.resize(small, (width, height), interpolation=cv2.INTER_LINEAR)
        if rng.random() < 0.2:
            smooth, share = cv2.GaussianBlur(image, (0, 0), 1.5), rng.uniform(0.2, 0.8)
            image = cv2.addWeighted(image, 1 + share, smooth, -share, 0)
        image = self._noisy(rng, image)
        return compressed(rng, image) if rng.random() < 0.3 else image
