# Tried by `buildah bud` on a Debian image with Python 3.13 under the name of the one below: the
# image analyzes, designs and draws as its user.  With python:3.12-slim itself it was not built.
# The command mcexact with what draws and python-control, for the files of the folder where it runs:
#     docker build -t mcexact .
#     docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" mcexact analyze plant.json
FROM python:3.12-slim AS built
COPY . /source
RUN pip wheel --no-cache-dir --no-deps --wheel-dir /wheels /source

FROM python:3.12-slim
COPY --from=built /wheels /wheels
RUN pip install --no-cache-dir "$(echo /wheels/*.whl)[plot,control]" && useradd --create-home user
# matplotlib keeps its fonts where any user may write.
ENV MPLCONFIGDIR=/tmp/matplotlib
USER user
WORKDIR /work
ENTRYPOINT ["mcexact"]
