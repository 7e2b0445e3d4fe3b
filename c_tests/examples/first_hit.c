// Shoots one ray at one triangle and says where it hits.
#include <gnomon.h>
#include <stdio.h>

int main(void) {
    const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const GnomonTriangles triangles = {.positions = corners, .vertex_count = 3, .triangle_count = 1};
    const GnomonRay ray = {.origin = {0.25f, 0.25f, 2}, .direction = {0, 0, -1}, .t_max = 10};
    GnomonScene* scene = NULL;
    GnomonHit hit;

    GnomonSceneBuilder* builder = gnomon_scene_builder_new();
    if (gnomon_scene_builder_add_triangles(builder, &triangles, NULL) != GNOMON_OK ||
        gnomon_scene_build(builder, NULL, &scene) != GNOMON_OK)
        fprintf(stderr, "%s\n", gnomon_last_error());
    else if (gnomon_intersect(scene, &ray, &hit))
        printf("hit triangle %u at t = %g\n", hit.primitive_id, hit.t);

    gnomon_scene_free(scene);
    gnomon_scene_builder_free(builder);
    return scene ? 0 : 1;
}
