# Untested: no image has been built from this file.
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
