/* Estimates poses in images, folders, videos or a camera: poses INPUT [MODEL] */
#include <opendr.h>
#include <stdio.h>

static int failed(const char *what) {
    fprintf(stderr, "%s: %s\n", what, opendr_last_error());
    return 1;
}

int main(int argc, char **argv) {
    opendr_learner *estimator = NULL;
    opendr_source *source = NULL;
    opendr_image *image = NULL;
    opendr_status status;
    if (argc < 2) return fprintf(stderr, "usage: poses INPUT [MODEL]\n"), 2;
    if (opendr_load_movenet(argc > 2 ? argv[2] : NULL, NULL, NULL, &estimator)) return failed("load");
    if (opendr_source_open(argv[1], &source)) return opendr_learner_free(&estimator), failed(argv[1]);
    while ((status = opendr_source_next(source, &image)) != OPENDR_OK || image != NULL) {
        opendr_pose_list *poses = NULL;
        opendr_pose pose;
        if (status != OPENDR_OK || opendr_infer_movenet(estimator, image, &poses) != OPENDR_OK) failed("skipped");
        else printf("%s\n", opendr_source_path(source));
        for (size_t i = 0; poses != NULL && i < opendr_pose_list_count(poses); i++) {
            opendr_pose_list_get(poses, i, &pose);
            printf("  nose at %.0f %.0f, score %.2f\n", pose.keypoints[0].x, pose.keypoints[0].y, pose.confidence);
        }
        opendr_pose_list_free(&poses);
        opendr_image_free(&image);
    }
    opendr_source_free(&source);
    opendr_learner_free(&estimator);
    return 0;
}
