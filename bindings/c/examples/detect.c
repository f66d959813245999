/* Detects objects in images, folders, videos or a camera: detect INPUT [MODEL] */
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
    if (argc < 2) return fprintf(stderr, "usage: detect INPUT [MODEL]\n"), 2;
    if (opendr_load_nanodet(argc > 2 ? argv[2] : NULL, NULL, "{\"threshold\": 0.4}", &detector)) return failed("load");
    if (opendr_source_open(argv[1], &source)) return opendr_learner_free(&detector), failed(argv[1]);
    while ((status = opendr_source_next(source, &image)) != OPENDR_OK || image != NULL) {
        opendr_bounding_box_list *boxes = NULL;
        opendr_bounding_box box;
        if (status != OPENDR_OK || opendr_infer_nanodet(detector, image, &boxes) != OPENDR_OK) {
            failed("skipped");
            opendr_image_free(&image);
            continue;
        }
        printf("%s\n", opendr_source_path(source));
        for (size_t i = 0; i < opendr_bounding_box_list_count(boxes); i++) {
            opendr_bounding_box_list_get(boxes, i, &box);
            printf("  %s %.2f at %.0f %.0f\n", box.label, box.confidence, box.left, box.top);
        }
        opendr_bounding_box_list_free(&boxes);
        opendr_image_free(&image);
    }
    opendr_source_free(&source);
    opendr_learner_free(&detector);
    return 0;
}
