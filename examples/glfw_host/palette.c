/* Median cut over the picture's distinct colours, then error diffusion. */
#include "palette.h"

#include <stdlib.h>
#include <string.h>

#include "vec.h"

typedef struct swatch {
    uint8_t c[3];
    uint32_t count;
} swatch;

typedef struct box {
    size_t first, count;
    double error; /* possible gain from splitting the box: variance along its longest axis times pixels */
    int axis;
    double mean[3];
} box;

/* Approximate weights of the eye for differences of encoded red, green and blue. */
static const float WEIGHTS[3] = {3, 4, 2};

static int by_color(const void *a, const void *b) { return memcmp(a, b, 3); }

static int sort_axis;
static int by_axis(const void *a, const void *b)
{
    return ((const swatch *)a)->c[sort_axis] - ((const swatch *)b)->c[sort_axis];
}

/* Collects the distinct colours, each with the number of its pixels. */
static size_t gather(swatch *list, const uint8_t *rgb, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        memcpy(list[i].c, rgb + 3 * i, 3);
        list[i].count = 1;
    }
    qsort(list, pixels, sizeof *list, by_color);
    size_t n = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (n > 0 && memcmp(list[n - 1].c, list[i].c, 3) == 0)
            list[n - 1].count++;
        else
            list[n++] = list[i];
    }
    return n;
}

static void measure(box *b, const swatch *list)
{
    double weight = 0.0, sum[3] = {0}, squares[3] = {0};
    for (size_t i = b->first; i < b->first + b->count; i++) {
        weight += list[i].count;
        for (int c = 0; c < 3; c++) {
            double v = list[i].c[c];
            sum[c] += v * list[i].count, squares[c] += v * v * list[i].count;
        }
    }
    b->error = 0.0;
    for (int c = 0; c < 3; c++) {
        double error = WEIGHTS[c] * (squares[c] - sum[c] * sum[c] / weight);
        b->mean[c] = sum[c] / weight;
        if (b->count > 1 && error > b->error)
            b->error = error, b->axis = c;
    }
}

/* Splits a box in two at the mean of its longest axis. */
static void split(box *low, box *high, swatch *list)
{
    sort_axis = low->axis;
    qsort(list + low->first, low->count, sizeof *list, by_axis);
    size_t k = 1;
    while (k < low->count - 1 && list[low->first + k].c[low->axis] <= low->mean[low->axis])
        k++;
    *high = (box){.first = low->first + k, .count = low->count - k};
    low->count = k;
    measure(low, list);
    measure(high, list);
}

static void cut(palette *p, swatch *list, size_t count)
{
    box boxes[256] = {{.count = count}};
    int n = 1;
    measure(&boxes[0], list);
    while (n < 256) {
        int worst = 0;
        for (int i = 1; i < n; i++)
            worst = boxes[i].error > boxes[worst].error ? i : worst;
        if (boxes[worst].error == 0.0)
            break;
        split(&boxes[worst], &boxes[n], list);
        n++;
    }
    for (int i = 0; i < n; i++)
        for (int c = 0; c < 3; c++)
            p->rgb[i][c] = (uint8_t)(boxes[i].mean[c] + 0.5);
    p->count = n;
}

static int nearest(const palette *p, const float c[3])
{
    int best = 0;
    float least = 1e9f;
    for (int i = 0; i < p->count; i++) {
        float r = c[0] - p->rgb[i][0], g = c[1] - p->rgb[i][1], b = c[2] - p->rgb[i][2];
        float d = WEIGHTS[0] * r * r + WEIGHTS[1] * g * g + WEIGHTS[2] * b * b;
        if (d < least)
            least = d, best = i;
    }
    return best;
}

bool palette_choose(palette *p, const uint8_t *rgb, int width, int height, uint8_t *indices)
{
    size_t pixels = (size_t)width * (size_t)height, row = ((size_t)width + 2) * 3;
    swatch *list = malloc(pixels * sizeof *list);
    float *errors = calloc(2 * row, sizeof *errors);
    if (list && errors)
        cut(p, list, gather(list, rgb, pixels));
    for (int y = 0; list && errors && y < height; y++) {
        float *here = errors + (size_t)(y % 2) * row, *below = errors + (size_t)(1 - y % 2) * row;
        int step = y % 2 ? -1 : 1; /* alternate the direction row by row, so that errors form no slanted lines */
        memset(below, 0, row * sizeof *below);
        for (int i = 0; i < width; i++) {
            int x = step > 0 ? i : width - 1 - i;
            const uint8_t *pixel = rgb + 3 * ((size_t)y * (size_t)width + (size_t)x);
            float wanted[3], *at = here + 3 * (x + 1), *under = below + 3 * (x + 1);
            for (int c = 0; c < 3; c++)
                wanted[c] = pixel[c] + (float)clamp(at[c], -48.0, 48.0);
            int k = nearest(p, wanted);
            indices[(size_t)y * (size_t)width + (size_t)x] = (uint8_t)k;
            for (int c = 0; c < 3; c++) {
                float e = (wanted[c] - p->rgb[k][c]) * (0.85f / 16.0f); /* 85 %: less noise, smaller file */
                at[3 * step + c] += 7.0f * e, under[-3 * step + c] += 3.0f * e;
                under[c] += 5.0f * e, under[3 * step + c] += e;
            }
        }
    }
    bool ok = list && errors;
    free(list);
    free(errors);
    return ok;
}
