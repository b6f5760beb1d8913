/* The article's widget, twice in one window with an overlay, resized; the program checks the widgets' pixels.
 * Arguments: samples, core or compatibility, a folder for pictures. */
#include <QApplication>
#include <QHBoxLayout>
#include <QSurfaceFormat>
#include <cstdio>
#include <cstring>

#include "weather_widget.hpp"

static int failed = 0;

static void expect(bool holds, const char *what, const QColor &seen)
{
    if (holds) return;
    std::printf("%s: %d %d %d\n", what, seen.red(), seen.green(), seen.blue());
    failed++;
}

/* Widget that counts the samples of the framebuffer it draws into. */
struct Counted : WeatherWidget {
    using WeatherWidget::WeatherWidget;
    void drawWorld(int w, int h) override
    {
        glGetIntegerv(GL_SAMPLES, &samples);
        WeatherWidget::drawWorld(w, h);
    }
    GLint samples = -1;
};

/* Checks that the sky above has more blue than red, that the dark board is veiled by weather, and that the overlay's
 * text is unchanged. */
static void look(const QImage &picture)
{
    const int w = picture.width(), h = picture.height();
    const QColor sky = picture.pixelColor(3 * w / 4, h / 8), board = picture.pixelColor(w / 4, 5 * h / 8);
    expect(sky.blue() > sky.red() + 10 && sky.blue() > 60, "the sky is blue", sky);
    expect(board.red() < 90 && board.blue() < 110, "the board hides the sky", board);
    int text = 0;
    for (int y = 4; y < 18; y++)
        for (int x = 8; x < w / 2; x++) text += qGray(picture.pixel(x, y)) < 40 || qGray(picture.pixel(x, y)) > 250;
    expect(text > 20, "the overlay's text is there", QColor(text, 0, 0));
}

int main(int argc, char **argv)
{
    if (argc != 4) return 2;
    QSurfaceFormat format;
    format.setVersion(3, 3);
    format.setProfile(std::strcmp(argv[2], "core") == 0 ? QSurfaceFormat::CoreProfile : QSurfaceFormat::CompatibilityProfile);
    format.setDepthBufferSize(24);
    format.setSamples(std::atoi(argv[1]));
    QSurfaceFormat::setDefaultFormat(format);
    QApplication application(argc, argv);
    {
        QWidget window;
        QHBoxLayout row(&window);
        Counted *widgets[2] = {new Counted("METAR EDDF 211020Z 24012KT CAVOK 20/12 Q1015"),
                               new Counted("METAR EDDF 211020Z 24012KT 8000 NSC 20/12 Q1015")};
        for (Counted *widget : widgets) row.addWidget(widget);
        const QSize sizes[] = {{520, 200}, {440, 260}};
        for (const QSize &size : sizes) {
            window.resize(size);
            window.show();
            for (int frame = 0; frame < 4; frame++) {
                for (Counted *widget : widgets) widget->repaint();
                application.processEvents();
            }
            for (Counted *widget : widgets) {
                const QImage picture = widget->grabFramebuffer();
                expect(picture.size() == widget->size() * widget->devicePixelRatioF(), "the picture has the widget's size", QColor());
                look(picture);
                picture.save(QString("%1/%2-%3.png").arg(argv[3]).arg(size.width()).arg(widget == widgets[0] ? "left" : "right"));
            }
        }
        for (Counted *widget : widgets)
            expect(widget->samples == std::atoi(argv[1]), "as many samples as were asked for", QColor(widget->samples, 0, 0));
    }
    std::printf(failed ? "failed\n" : "ok\n");
    return failed ? 1 : 0;
}
