/* PNG files by libpng. libpng reports errors by longjmp, so nothing is allocated between setjmp and the libpng
 * calls. */
#include "png_file.h"

#include <stdio.h>
#include <stdlib.h>

#include <png.h>

#include "../command_line.h"

static void on_fault(png_structp png, png_const_charp message)
{
    fprintf(stderr, "%s: %s\n", (const char *)png_get_error_ptr(png), message);
    png_longjmp(png, 1);
}

static bool fail(const char *path, const char *why)
{
    fprintf(stderr, "%s: %s\n", path, why);
    return false;
}

bool png_read_grey16(const char *path, uint16_t **pixels, int *width, int *height)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return fail(path, "cannot be read");
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, (png_voidp)path, on_fault, NULL);
    png_infop info = png_create_info_struct(png);
    uint16_t *volatile data = NULL;
    volatile bool ok = false;
    if (!setjmp(png_jmpbuf(png))) {
        png_init_io(png, file);
        png_read_info(png, info);
        *width = (int)png_get_image_width(png, info);
        *height = (int)png_get_image_height(png, info);
        if (png_get_bit_depth(png, info) != 16 || png_get_color_type(png, info) != PNG_COLOR_TYPE_GRAY)
            png_error(png, "is not a 16-bit grey picture");
        png_set_swap(png); /* PNG is big-endian; the machines that run this are little-endian */
        int passes = png_set_interlace_handling(png);
        data = malloc((size_t)*width * (size_t)*height * sizeof *data);
        if (!data)
            png_error(png, "is too large");
        for (int pass = 0; pass < passes; pass++)
            for (int row = 0; row < *height; row++)
                png_read_row(png, (png_bytep)(data + (size_t)row * (size_t)*width), NULL);
        ok = true;
    }
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
    if (!ok) {
        free(data);
        return false;
    }
    *pixels = data;
    return true;
}

/* Writes rows of RGB, or of palette indices if there is a palette. */
static bool write_rows(const char *path, const uint8_t *pixels, int width, int height, const uint8_t (*colors)[3], int count)
{
    const size_t row_bytes = (size_t)width * (colors ? 1 : 3);
    FILE *file = fopen(part_begin(path), "wb");
    if (!file)
        return part_end(path, false) || fail(path, "cannot be written"); /* no partial file is left */
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, (png_voidp)path, on_fault, NULL);
    png_infop info = png_create_info_struct(png);
    volatile bool ok = false;
    if (!setjmp(png_jmpbuf(png))) {
        png_init_io(png, file);
        png_set_IHDR(png, info, (png_uint_32)width, (png_uint_32)height, 8,
                     colors ? PNG_COLOR_TYPE_PALETTE : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                     PNG_FILTER_TYPE_DEFAULT);
        if (colors) {
            png_color list[256];
            for (int i = 0; i < count; i++)
                list[i] = (png_color){colors[i][0], colors[i][1], colors[i][2]};
            png_set_PLTE(png, info, list, count);
            png_set_compression_level(png, 9);
        }
        png_write_info(png, info);
        for (int row = 0; row < height; row++)
            png_write_row(png, (png_const_bytep)(pixels + (size_t)row * row_bytes));
        png_write_end(png, info);
        ok = true;
    }
    png_destroy_write_struct(&png, &info);
    ok = fclose(file) == 0 && ok;
    return part_end(path, ok) || (ok && fail(path, "cannot be written"));
}

bool png_write_rgb8(const char *path, const uint8_t *pixels, int width, int height)
{
    return write_rows(path, pixels, width, height, NULL, 0);
}

bool png_write_indexed(const char *path, const uint8_t *indices, int width, int height, const uint8_t (*colors)[3], int count)
{
    return write_rows(path, indices, width, height, colors, count);
}
