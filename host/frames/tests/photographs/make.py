#!/usr/bin/env python3
"""Makes the photographs here, and for each a PNG of what Pillow shows (NAME.png).

    python3 -m venv .venv && . .venv/bin/activate
    pip install Pillow numpy && ./make.py

Made with Pillow 13.0.0 (libjpeg-turbo 3.2.0, libwebp). The tests read the committed files; nothing runs this script again.
"""

import numpy as np
from PIL import Image, ImageOps

WIDTH, HEIGHT = 72, 48


def smooth(width, height):
    """A slope in each colour, without edges: JPEG decoders may differ in how they spread colours across an edge."""
    y, x = np.mgrid[0:height, 0:width]
    red, green, blue = 30 + 180 * x // (width - 1), 40 + 170 * y // (height - 1), 220 - 90 * (x + y) // (width + height - 2)
    return Image.fromarray(np.stack([red, green, blue], -1).astype("uint8"))


def edged(width, height):
    """Like smooth(), with squares of other colours, for codings that keep every pixel."""
    pixels = np.asarray(smooth(width, height)).copy()
    pixels[5:15, 7:22] = [230, 20, 10]
    pixels[20:41, 33:34] = [0, 255, 128]
    return Image.fromarray(pixels)


def keep(name, image=None, **how):
    """Saves an image, if one is given, and what Pillow shows of the file."""
    if image is not None:
        image.save(name, **how)
    seen = ImageOps.exif_transpose(Image.open(name)).convert("RGB")
    seen.save(f"{name}.png")


def turned(orientation):
    exif = Image.Exif()
    exif[0x0112] = orientation
    return exif


def fitted(source, name, size):
    """Saves what a crop about the centre and the Catmull-Rom filter (Pillow's bicubic) make of a picture."""
    image = ImageOps.exif_transpose(Image.open(source)).convert("RGB")
    wide = image.width * size[1] > size[0] * image.height
    part = (image.height * size[0] // size[1], image.height) if wide else (image.width, image.width * size[1] // size[0])
    left, top = (image.width - part[0]) // 2, (image.height - part[1]) // 2
    box = (left, top, left + part[0], top + part[1])
    image.crop(box).resize(size, Image.Resampling.BICUBIC).save(name)


def main():
    plain, sharp = smooth(WIDTH, HEIGHT), edged(WIDTH, HEIGHT)
    keep("baseline.jpg", plain, quality=95, subsampling=0)
    keep("subsampled.jpg", plain, quality=95, subsampling=2)
    keep("progressive.jpg", plain, quality=95, progressive=True, subsampling=0)
    keep("grey.jpg", plain.convert("L"), quality=95)
    for orientation in range(2, 9):
        keep(f"turned{orientation}.jpg", plain, quality=95, subsampling=0, exif=turned(orientation))
    plain.convert("CMYK").save("cmyk.jpg")
    keep("lossy.webp", plain, quality=95)
    keep("lossless.webp", sharp, lossless=True)
    keep("turned6.webp", sharp, lossless=True, exif=turned(6))
    alpha = sharp.convert("RGBA")
    alpha.putalpha(Image.linear_gradient("L").resize(alpha.size).point(lambda value: max(value, 1)))
    alpha.save("alpha.webp", lossless=True, exact=True)
    keep("alpha.webp")
    sharp.save("animated.webp", save_all=True, append_images=[ImageOps.mirror(sharp)], duration=100, lossless=True)
    keep("colour.bmp", sharp)
    keep("palette.bmp", sharp.quantize(16))
    keep("grey.bmp", sharp.convert("L"))
    keep("alpha.bmp", alpha.convert("RGBA"))
    plain.save("picture.avif", quality=95)
    edged(200, 160).save("large.webp", lossless=True, exif=turned(6))
    fitted("large.webp", "large.fitted.png", (64, 48))
    edged(160, 100).save("small.png")
    fitted("small.png", "small.fitted.png", (192, 96))


if __name__ == "__main__":
    main()
