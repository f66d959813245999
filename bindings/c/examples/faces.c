/* Detects faces in images, folders, videos or a camera and saves the last image with the faces drawn:
 * faces INPUT [MODEL [OUT.png]] */
#include <opendr.h>
#include <stdio.h>

static int failed(const char *what) {
    fprintf(stderr, "%s: %s\n", what, opendr_last_error());
    return 1;
}

int main(int argc, char **argv) {
    opendr_learner *detector = NULL;
    opendr_source *source = NULL;
    opendr_image *image = NULL;
    opendr_status status;
    if (argc < 2) return fprintf(stderr, "usage: faces INPUT [MODEL [OUT.png]]\n"), 2;
    if (opendr_load_ultra_light_face(argc > 2 ? argv[2] : NULL, NULL, NULL, &detector)) return failed("load");
    if (opendr_source_open(argv[1], &source)) return opendr_learner_free(&detector), failed(argv[1]);
    while ((status = opendr_source_next(source, &image)) != OPENDR_OK || image != NULL) {
        opendr_bounding_box_list *faces = NULL;
        if (status != OPENDR_OK || opendr_infer_ultra_light_face(detector, image, &faces) != OPENDR_OK) {
            failed("skipped");
        } else {
            printf("%s: %zu faces\n", opendr_source_path(source), opendr_bounding_box_list_count(faces));
            opendr_bounding_box_list_draw(faces, image);
            if (argc > 3 && opendr_image_save(image, argv[3])) failed(argv[3]);
        }
        opendr_bounding_box_list_free(&faces);
        opendr_image_free(&image);
    }
    opendr_source_free(&source);
    opendr_learner_free(&detector);
    return 0;
}
