/* Growing vertex and index lists, boxes, prisms and cones. */
#include "mesh.h"

#include <stdio.h>
#include <stdlib.h>

static void *grow(void *list, size_t count, size_t *room, size_t item)
{
    if (count < *room)
        return list;
    *room = *room ? *room * 2 : 1024;
    list = realloc(list, *room * item);
    if (!list) {
        fprintf(stderr, "out of memory\n");
        exit(1);
    }
    return list;
}

uint32_t mesh_vertex(mesh *m, vertex v)
{
    m->vertices = grow(m->vertices, m->vertex_count, &m->vertex_room, sizeof v);
    m->vertices[m->vertex_count] = v;
    return (uint32_t)m->vertex_count++;
}

void mesh_triangle(mesh *m, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t corner[3] = {a, b, c};
    for (int i = 0; i < 3; i++) {
        m->indices = grow(m->indices, m->index_count, &m->index_room, sizeof *m->indices);
        m->indices[m->index_count++] = corner[i];
    }
}

void mesh_free(mesh *m)
{
    free(m->vertices);
    free(m->indices);
    *m = (mesh){0};
}

static vertex plain(vec3 p, vec3 n, vec3 albedo)
{
    return (vertex){{(float)p.x, (float)p.y, (float)p.z},
                    {(float)n.x, (float)n.y, (float)n.z},
                    {(float)albedo.x, (float)albedo.y, (float)albedo.z},
                    1e4f};
}

void mesh_box(mesh *m, mat4 place, vec3 size, vec3 albedo)
{
    for (int face = 0; face < 6; face++) {
        int axis = face / 2;
        double sign = face % 2 ? 1.0 : -1.0, half[3] = {0.5 * size.x, 0.5 * size.y, 0.5 * size.z};
        double n[3] = {0, 0, 0};
        n[axis] = sign;
        vec3 normal = transform_direction(place, vec(n[0], n[1], n[2]));
        uint32_t first = (uint32_t)m->vertex_count;
        for (int corner = 0; corner < 4; corner++) {
            double p[3];
            p[axis] = sign * half[axis];
            p[(axis + 1) % 3] = (corner == 1 || corner == 2 ? 1.0 : -1.0) * half[(axis + 1) % 3];
            p[(axis + 2) % 3] = (corner >= 2 ? 1.0 : -1.0) * half[(axis + 2) % 3] * sign;
            mesh_vertex(m, plain(transform_point(place, vec(p[0], p[1], p[2])), normal, albedo));
        }
        mesh_triangle(m, first, first + 1, first + 2);
        mesh_triangle(m, first, first + 2, first + 3);
    }
}

void mesh_prism(mesh *m, const double (*outline)[2], int corners, double foot, double top, vec3 albedo, vec3 lid)
{
    uint32_t middle = mesh_vertex(m, plain(vec(0, 0, top), vec(0, 0, 1), lid));
    for (int i = 0; i < corners; i++) {
        const double *a = outline[i], *b = outline[(i + 1) % corners];
        vec3 side = normalize(vec(b[1] - a[1], a[0] - b[0], 0)), up = vec(0, 0, 1);
        uint32_t wall = mesh_vertex(m, plain(vec(a[0], a[1], foot), side, albedo));
        mesh_vertex(m, plain(vec(b[0], b[1], foot), side, albedo));
        mesh_vertex(m, plain(vec(b[0], b[1], top), side, albedo));
        mesh_vertex(m, plain(vec(a[0], a[1], top), side, albedo));
        mesh_triangle(m, wall, wall + 1, wall + 2);
        mesh_triangle(m, wall, wall + 2, wall + 3);
        uint32_t edge = mesh_vertex(m, plain(vec(a[0], a[1], top), up, lid));
        mesh_vertex(m, plain(vec(b[0], b[1], top), up, lid));
        mesh_triangle(m, middle, edge, edge + 1);
    }
}

void mesh_cone(mesh *m, vec3 foot, double radius, double height, int sides, vec3 albedo)
{
    uint32_t first = (uint32_t)m->vertex_count;
    for (int i = 0; i < sides; i++) {
        double a = 2.0 * PI * i / sides;
        vec3 out = vec(cos(a), sin(a), 0.0);
        vec3 normal = normalize(vec(out.x, out.y, radius / height));
        mesh_vertex(m, plain(add(foot, scale(out, radius)), normal, scale(albedo, 0.7)));
        mesh_vertex(m, plain(add(foot, vec(0, 0, height)), normal, albedo));
    }
    for (int i = 0; i < sides; i++) {
        uint32_t here = first + 2 * (uint32_t)i, next = first + 2 * (uint32_t)((i + 1) % sides);
        mesh_triangle(m, here, next, here + 1);
    }
}
