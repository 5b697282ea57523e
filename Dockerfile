# Untested: no image has been built from this file.
# The command mcexact with what draws and python-control:
#     docker build -t mcexact . && docker run --rm -v "$PWD:/work" mcexact analyze plant.json
FROM python:3.12-slim
COPY . /source
RUN pip install --no-cache-dir '/source[plot,control]' && rm -rf /source \
    && useradd --create-home user
USER user
WORKDIR /work
ENTRYPOINT ["mcexact"]
