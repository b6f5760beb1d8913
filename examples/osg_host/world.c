#include "world.h"

#include "../glfw_host/ground.h"
#include "../glfw_host/objects.h"

static ground land;
static mesh land_mesh, object_mesh;

_Static_assert(sizeof(vertex) == WORLD_FLOATS * sizeof(float), "a vertex is its floats, one after the other");

int world_load(const char *heights_png, world_site *site)
{
    if (!ground_load(&land, heights_png))
        return 0;
    vec3 eye = objects_survey_eye(&land);
    double x, y;
    ground_pad(&x, &y);
    *site = (world_site){SITE_LATITUDE_DEG,           SITE_LONGITUDE_DEG, 0.0, SITE_VIEW_AZIMUTH_DEG,
                         {x, y, ground_z(&land, x, y)}, {eye.x, eye.y, eye.z}};
    return 1;
}

double world_height(double east, double north) { return ground_z(&land, east, north); }

static world_mesh arrays(const mesh *m)
{
    return (world_mesh){(const float *)m->vertices, m->indices, m->vertex_count, m->index_count};
}

world_mesh world_ground(void)
{
    if (land_mesh.vertex_count == 0)
        ground_mesh(&land, &land_mesh);
    return arrays(&land_mesh);
}

world_mesh world_objects(void)
{
    if (object_mesh.vertex_count == 0)
        objects_mesh(&land, &object_mesh);
    return arrays(&object_mesh);
}

void world_free(void)
{
    mesh_free(&land_mesh);
    mesh_free(&object_mesh);
    ground_free(&land);
}
